"""Locates the files to which RAWSim-O's settings files (.xsett) refer."""

from __future__ import annotations

from pathlib import Path, PureWindowsPath

from rmfs.errors import InputError

_FOLDERS = (
    *(".", "Resources", "resources", "Wordlists", "wordlists", "Resources/Wordlists"),
    *("Material/Resources", "Material/Resources/Wordlists"),
)


def find_beside(settings: Path, named: str, suffix: str) -> Path:
    """Return the absolute path of a file to which a settings file refers.

    The path `named` is tried first, relative to the folder of the settings file. Then the file is
    sought by its name alone, in that folder and all folders above it; in each of these folders,
    subfolders such as `Resources` and `Wordlists` are searched as well.

    Parameters
    ----------
    settings
        The settings file.
    named
        The path given in the settings file; it may be a Windows path.
    suffix
        Required suffix of the path. It prevents a settings file of unknown origin from causing
        files of other kinds to be read.

    Raises
    ------
    InputError
        If the file is not found, or `named` has another suffix.
    """
    # the names were written on Windows
    path = Path(PureWindowsPath(named).as_posix())
    if path.suffix.lower() != suffix:
        raise InputError(f"{settings}: names the file {named!r:.80}, which must end in {suffix}")
    folder = settings.resolve().parent
    candidates = [folder / path]
    for above in (folder, *folder.parents):
        candidates += [above / resources / path.name for resources in _FOLDERS]
    for candidate in candidates:
        if candidate.is_file():
            return candidate.resolve()
    raise InputError(
        f"{settings}: names the file {named}, which is neither in the same folder nor in a folder "
        "of resources above it"
    )
