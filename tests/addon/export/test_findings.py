"""Notes are few, whatever the size of the scene."""

from glanz.addon.export.findings import Findings


def test_equal_notes_become_one_line_with_names_and_a_count():
    findings = Findings()
    for i in range(1000):
        findings.note("hair is not rendered", f"object '{i % 10}'")
    findings.note("volumes are not rendered", "object 'Fog'")
    assert findings.lines() == (
        "hair is not rendered: object '0', object '1', object '2', object '3' and 6 more",
        "volumes are not rendered: object 'Fog'",
    )
