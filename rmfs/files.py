"""Reading what anybody gives us, and writing so that nothing half-written is ever seen."""

from __future__ import annotations

import ctypes
import errno
import fcntl
import os
import shutil
import tempfile
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator


_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EFBIG)
LARGEST_MIB = 64
"""Most that is read of a file that is read whole; the largest published layout takes 4."""


def read_bounded(path: Path, largest_mib: int = LARGEST_MIB) -> bytes:
    """Read a file whole, unless it is so large that it would take the memory.

    Parameters
    ----------
    largest_mib
        Most mebibytes it may have.

    Raises
    ------
    InputError
        If the file is missing, cannot be read, or is too large.
    """
    try:
        with path.open("rb") as file:
            content = file.read((largest_mib << 20) + 1)
    except FileNotFoundError:
        raise InputError(f"{path}: no such file") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from None
    if len(content) > largest_mib << 20:
        raise InputError(f"{path}: larger than {largest_mib} MiB")
    return content


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Yield a temporary path beside `path`; rename it to `path` on success, remove it on failure.

    Raises
    ------
    InputError
        If the folder cannot be written.
    """
    if path.is_dir():
        raise InputError(f"{path}: is a folder, not a file to write")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror})") from None
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        temporary.chmod(0o644)
        with temporary.open("rb") as file:
            os.fsync(file.fileno())  # or a machine that stops may know the name of an empty file
        temporary.replace(path)
    except OSError as error:
        if error.errno in _FULL:
            raise InputError(f"{path}: cannot be written ({error.strerror})") from None
        raise
    finally:
        temporary.unlink(missing_ok=True)


def write_text(path: Path, text: str) -> None:
    """Write a text file whole or not at all (UTF-8)."""
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


@contextmanager
def replacing_folder(target: Path, mark: str, what: str, *, replace: bool = True) -> Iterator[Path]:
    """Yield a temporary folder beside `target`, which takes that name if all goes well.

    The folder is made at once, so that a target that cannot be written is noticed before any work
    is done. On an error or an interruption it is removed again, with the folders made on the way.
    Nobody else can write the same target meanwhile.

    Parameters
    ----------
    mark
        A file that every such folder holds: only these, and empty ones, are replaced.
    what
        What such a folder is called.
    replace
        Whether a folder of the kind may be replaced. Default yes.

    Raises
    ------
    InputError
        If the target cannot be written, somebody else writes it, or it exists and is not such a
        folder or must not be replaced.
    """
    target = target.absolute()
    _refuse_strangers(target, mark, what)
    made = _missing_parents(target)
    try:
        with _locked(target):
            if not replace and (target / mark).exists():
                raise InputError(
                    f"{target}: there is a {what} of this name already; --force replaces it, --out "
                    "names another"
                )
            temporary = _temporary_beside(target)
            try:
                yield temporary
                _allow_all_to_read(temporary)
                _put_in_place(temporary, target)
            finally:
                shutil.rmtree(temporary, ignore_errors=True)
    except BaseException:
        _remove_empty(made)
        raise


@contextmanager
def _locked(target: Path) -> Iterator[None]:
    """Keep others from writing the same target; the lock ends with the process in any case."""
    lock = target.with_name(f".{target.name}.lock")
    while True:
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
            file = lock.open("w")
        except OSError as error:
            raise InputError(f"{target}: cannot be written ({error.strerror})") from None
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            file.close()
            raise InputError(f"{target}: is being written by another process") from None
        if _is_at(lock, file.fileno()):
            break
        file.close()  # removed by its owner between opening and locking
    try:
        yield
    finally:
        lock.unlink(missing_ok=True)
        file.close()


def _is_at(path: Path, descriptor: int) -> bool:
    """Whether an open file still has its name."""
    try:
        return path.stat().st_ino == os.fstat(descriptor).st_ino
    except FileNotFoundError:
        return False


def _refuse_strangers(target: Path, mark: str, what: str) -> None:
    """Refuse to replace anything but an empty folder or one of the kind."""
    try:
        if target.exists() and not target.is_dir():
            raise InputError(f"{target}: is not a folder")
        if target.is_dir() and any(target.iterdir()) and not (target / mark).is_file():
            raise InputError(f"{target}: exists and is not a {what}; it is left alone")
    except OSError as error:
        raise InputError(f"{target}: cannot be written ({error.strerror})") from None


def _allow_all_to_read(folder: Path) -> None:
    try:
        folder.chmod(0o755)
    except OSError as error:
        raise InputError(f"{folder}: cannot be written ({error.strerror})") from None


def _missing_parents(target: Path) -> list[Path]:
    """Return the folders above `target` that do not exist, innermost first."""
    return [parent for parent in target.parents if not parent.exists()]


def _temporary_beside(target: Path) -> Path:
    """Make a folder to write in; one that a killed process has left is removed.

    The target is locked, so that nobody else writes in such a folder.
    """
    prefix = f".{target.name}.partial-"
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        for left in target.parent.iterdir():
            if left.name.startswith(prefix):
                shutil.rmtree(left, ignore_errors=True)
        return Path(tempfile.mkdtemp(dir=target.parent, prefix=prefix))
    except OSError as error:
        raise InputError(f"{target}: cannot be written ({error.strerror})") from None


def _put_in_place(temporary: Path, target: Path) -> None:
    """Rename the finished folder; an older one of that name takes its place until it is removed.

    The two are exchanged at once, so that whoever is killed leaves one of them under the name.
    """
    try:
        if not target.exists():
            temporary.replace(target)
        elif not _exchanged(temporary, target):
            _put_in_place_by_steps(temporary, target)
    except OSError as error:
        raise InputError(f"{target}: cannot be written ({error.strerror})") from None


_EXCHANGE = 2
_HERE = -100


def _exchanged(one: Path, other: Path) -> bool:
    """Exchange two folders at once (Linux); False where the system cannot."""
    try:
        rename = ctypes.CDLL(None, use_errno=True).renameat2
    except (OSError, AttributeError):  # another system
        return False
    if rename(_HERE, os.fsencode(one), _HERE, os.fsencode(other), _EXCHANGE) == 0:
        return True
    number = ctypes.get_errno()
    if number in (errno.ENOSYS, errno.EINVAL):  # another file system
        return False
    raise OSError(number, os.strerror(number))


def _put_in_place_by_steps(temporary: Path, target: Path) -> None:
    aside = Path(tempfile.mkdtemp(dir=target.parent, prefix=f".{target.name}.old."))
    try:
        target.replace(aside / target.name)
        try:
            temporary.replace(target)
        except BaseException:
            (aside / target.name).replace(target)
            raise
    finally:
        shutil.rmtree(aside, ignore_errors=True)


def _remove_empty(folders: list[Path]) -> None:
    for folder in folders:
        try:
            folder.rmdir()
        except OSError:
            return
