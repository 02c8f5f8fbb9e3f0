"""The newest LLVM with which Mitsuba renders is taken."""

import pytest

from glanz.benchmarks.peers import llvm


@pytest.fixture
def libraries(tmp_path, monkeypatch):
    """Of four versions, one of them too old; and no other on this machine."""
    monkeypatch.delenv(llvm.VARIABLE, raising=False)
    monkeypatch.setattr(llvm, "FOLDERS", (str(tmp_path / "*").lstrip("/"),))
    (tmp_path / "lib").mkdir()
    for name in ("libLLVM-15.so.1", "libLLVM-18.so.1", "libLLVM.so.19.1", "libLLVM-16.so.1", "libLLVMSupport.so"):
        (tmp_path / "lib" / name).touch()
    (tmp_path / "lib" / "libLLVM.so").symlink_to("libLLVM.so.19.1")
    return tmp_path / "lib"


def test_newest_first_and_none_that_is_too_old(libraries):
    assert [path.name for path in llvm.candidates()] == ["libLLVM.so.19.1", "libLLVM-18.so.1", "libLLVM-16.so.1"]


def test_what_is_named_stands_before_all(libraries, monkeypatch):
    monkeypatch.setenv(llvm.VARIABLE, str(libraries / "libLLVM-15.so.1"))
    assert [path.name for path in llvm.candidates()][:2] == ["libLLVM-15.so.1", "libLLVM.so.19.1"]


def test_one_that_does_not_render_is_passed_over(libraries, monkeypatch):
    monkeypatch.setattr(llvm, "_renders", lambda path: llvm.version(path.name) < 19)
    assert llvm.find().name == "libLLVM-18.so.1"
    monkeypatch.setattr(llvm, "_renders", lambda path: False)
    assert llvm.find() is None
    assert "libllvm" in llvm.CURE and llvm.VARIABLE in llvm.CURE
