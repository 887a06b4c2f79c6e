"""Reading of untrusted files, and writing that never leaves a partial file behind."""

from __future__ import annotations

import ctypes
import errno
import fcntl
import os
import re
import shutil
import tempfile
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator


_PARTIAL = re.compile(r"\.(?P<target>.+)\.partial-[a-z0-9_]{8}")
"""Pattern of the names of temporary folders beside their targets, made by `tempfile.mkdtemp`."""

_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EFBIG)
LARGEST_MIB = 64
"""Default size limit, in MiB, of a file read as a whole; the largest published layout has 4 MiB."""


def read_bounded(path: Path, largest_mib: int = LARGEST_MIB) -> bytes:
    """Read a whole file, unless it is too large.

    Parameters
    ----------
    largest_mib
        Size limit in mebibytes.

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

    Missing parent folders are created.

    Raises
    ------
    InputError
        If `path` is a folder, a device or a pipe, if its parent folder cannot be written, or if the
        disk is full.
    """
    if path.is_dir():
        raise InputError(f"{path}: is a folder, not a file to write")
    if path.exists() and not path.is_file():  # renaming would replace the device by a file
        raise InputError(f"{path}: is a device or a pipe, not a file to write")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    except (FileExistsError, NotADirectoryError):
        raise InputError(f"{path}: cannot be written ({path.parent} is not a folder)") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror})") from None
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        temporary.chmod(0o644)
        with temporary.open("rb") as file:
            os.fsync(file.fileno())  # otherwise a system crash could leave an empty file
        temporary.replace(path)
    except OSError as error:
        if error.errno in _FULL:
            raise InputError(f"{path}: cannot be written ({error.strerror})") from None
        raise
    finally:
        temporary.unlink(missing_ok=True)


def write_text(path: Path, text: str) -> None:
    """Write a text file (UTF-8), completely or not at all; raises errors as `replacing` does."""
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


@contextmanager
def replacing_folder(target: Path, mark: str, what: str, *, replace: bool = True) -> Iterator[Path]:
    """Yield a temporary folder beside `target`; rename this folder to `target` on success.

    The temporary folder is created when the context is entered, so that a target that cannot be
    written is noticed early. On an error or an interruption, the temporary folder is removed,
    together with any parent folders created for it. While the context is open, the target is locked
    against other processes.

    Parameters
    ----------
    mark
        Name of a file by which a folder of the same kind as `target` (for example, a run folder)
        is recognised: an existing folder without this file is replaced only if it is empty.
    what
        Name of this kind of folder in messages.
    replace
        Whether an existing folder that contains the file `mark` may be replaced. Default True.

    Raises
    ------
    InputError
        If the target cannot be written, is locked by another process or contains the working
        directory, or if it exists and must not be replaced.
    """
    target = target.absolute()
    here = Path.cwd()
    if target.resolve() in (here, *here.parents):
        raise InputError(f"{target}: is the working directory or contains it; name another folder")
    _refuse_strangers(target, mark, what)
    made = _missing_parents(target)
    try:
        with _locked(target):
            if not replace and (target / mark).exists():
                raise InputError(
                    f"{target}: a {what} of this name exists already; --force replaces it, --out "
                    "chooses another name"
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
    """Lock the target against other processes; the lock ends with the process in any case."""
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
        file.close()  # the owner removed it between opening and locking
    try:
        yield
    finally:
        lock.unlink(missing_ok=True)
        file.close()


def _is_at(path: Path, descriptor: int) -> bool:
    """Whether an open file is still found under its name."""
    try:
        return path.stat().st_ino == os.fstat(descriptor).st_ino
    except FileNotFoundError:
        return False


def _refuse_strangers(target: Path, mark: str, what: str) -> None:
    """Refuse to replace anything but an empty folder or one of the same kind."""
    try:
        if target.exists() and not target.is_dir():
            raise InputError(f"{target}: is not a folder")
        if target.is_dir() and any(target.iterdir()) and not (target / mark).is_file():
            raise InputError(f"{target}: exists and is not a {what}; it is not replaced")
    except OSError as error:
        raise InputError(f"{target}: cannot be written ({error.strerror})") from None


def _allow_all_to_read(folder: Path) -> None:
    try:
        folder.chmod(0o755)
    except OSError as error:
        raise InputError(f"{folder}: cannot be written ({error.strerror})") from None


def _missing_parents(target: Path) -> list[Path]:
    """Return the parent folders of `target` that do not exist, innermost first."""
    return [parent for parent in target.parents if not parent.exists()]


def _temporary_beside(target: Path) -> Path:
    """Create the temporary folder, after removing those left behind by killed processes.

    The target is locked, so no other process writes to a temporary folder of it.
    """
    prefix = f".{target.name}.partial-"
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        for left in target.parent.iterdir():
            if left.name.startswith(prefix):
                shutil.rmtree(left, ignore_errors=True)
            elif (owner := _PARTIAL.fullmatch(left.name)) and left.is_dir():
                _sweep(left, target.with_name(owner["target"]))
        return Path(tempfile.mkdtemp(dir=target.parent, prefix=prefix))
    except OSError as error:
        raise InputError(f"{target}: cannot be written ({error.strerror})") from None


def _sweep(left: Path, owner: Path) -> None:
    """Remove the temporary folder of another target, unless a process is writing it."""
    try:
        with _locked(owner):
            shutil.rmtree(left, ignore_errors=True)
    except InputError:
        return


def _put_in_place(temporary: Path, target: Path) -> None:
    """Rename the finished folder; an older one of that name is exchanged with it and removed.

    The exchange is atomic, so that a killed process leaves one of the two under the name.
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
    """Exchange two folders atomically (Linux); return False if the system cannot."""
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
