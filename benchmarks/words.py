"""The words after a benchmark's name, for those that have parts."""

import argparse


def asked(module, about, part, known, without, words=None):
    """(names of parts, all that are `known` if none is given, whether it shall be quick) of `words`, those of the process if None.

    part     what a part is called
    without  what being quick leaves out
    """
    parser = argparse.ArgumentParser(prog=f"python -m {module}", description=about.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help=without)
    parser.add_argument("names", nargs="*", metavar=part, help=f"of: {' '.join(known)}; none: all")
    found = parser.parse_args(words)
    if unknown := set(found.names) - set(known):
        parser.error(f"unknown: {', '.join(sorted(unknown))}; known: {', '.join(known)}")
    return found.names or list(known), found.quick
