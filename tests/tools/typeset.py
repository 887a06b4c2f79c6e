r"""Typeset a LaTeX table and take its picture.

`python -m tests.tools.typeset TABLE.tex TABLE.png` does both.

The table is put into a document with no more than it asks for (booktabs, siunitx) and compiled by
tectonic or pdflatex, whichever is there. The picture carries the hash of the table, so that a
picture can be held against the table it claims to show.
"""

from __future__ import annotations

import argparse
import hashlib
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from rmfs.errors import InputError
from rmfs.files import replacing

DOCUMENT = r"""\documentclass{article}
\usepackage[a3paper,landscape,margin=1cm]{geometry}
\usepackage[T1]{fontenc}
\usepackage{booktabs,siunitx}
\pagestyle{empty}
\begin{document}
%s
\end{document}
"""

ENGINES = {
    "tectonic": ("tectonic", "--chatter=minimal"),
    "pdflatex": ("pdflatex", "-interaction=nonstopmode", "-halt-on-error"),
}
DOTS_PER_INCH = 160
MARGIN = 12
"""Pixels left around the picture."""

SOURCE = "table-sha256"
"""Where a picture says which table it shows."""


def engine() -> str | None:
    """Return the program that compiles, if there is one."""
    return next((name for name in ENGINES if shutil.which(name)), None)


def compiled(table: str, folder: Path) -> Path:
    """Compile a table and return the PDF file.

    Parameters
    ----------
    table
        LaTeX, as `Table.latex` returns it.
    folder
        Where the document and what LaTeX leaves behind go.

    Raises
    ------
    InputError
        If there is no LaTeX, or it does not understand the table.
    """
    chosen = engine()
    if chosen is None:
        raise InputError(f"typesetting needs one of {', '.join(ENGINES)}, and none is installed")
    source = folder / "document.tex"
    source.write_text(DOCUMENT % table, encoding="utf-8")
    told = subprocess.run(
        [*ENGINES[chosen], source.name], cwd=folder, capture_output=True, text=True, check=False
    )
    if told.returncode:
        wrong = [line for line in told.stdout.splitlines() if line.startswith("!")]
        raise InputError(f"{chosen}: {(wrong or told.stderr.splitlines() or ['failed'])[0]}")
    return source.with_suffix(".pdf")


def picture(table: str, path: Path) -> None:
    """Write a picture (.png) of a table.

    Raises
    ------
    InputError
        If it cannot be compiled, or pdftoppm (of Poppler) is missing.
    """
    from PIL import Image, ImageChops, PngImagePlugin

    if shutil.which("pdftoppm") is None:
        raise InputError("a picture of a PDF file needs pdftoppm (of Poppler), which is missing")
    with tempfile.TemporaryDirectory() as name:
        pdf = compiled(table, Path(name))
        page = pdf.with_suffix("")
        resolution = ["-r", str(DOTS_PER_INCH)]
        subprocess.run(["pdftoppm", "-png", "-singlefile", *resolution, pdf, page], check=True)
        with Image.open(page.with_suffix(".png")) as image:
            drawn = image.convert("L")
    box = ImageChops.invert(drawn).getbbox()
    if box is None:
        raise InputError("the page is empty")
    left, top, right, bottom = box
    about = PngImagePlugin.PngInfo()
    about.add_text(SOURCE, digest(table))
    with replacing(path) as temporary:
        drawn.crop((left - MARGIN, top - MARGIN, right + MARGIN, bottom + MARGIN)).save(
            temporary, "PNG", pnginfo=about
        )


def shown_by(path: Path) -> str:
    """Return the hash of the table that a picture shows; empty if it does not say."""
    from PIL import Image

    with Image.open(path) as image:
        return str(image.info.get(SOURCE, ""))


def digest(table: str) -> str:
    """Return the hash of a table."""
    return hashlib.sha256(table.encode()).hexdigest()


def main(arguments: list[str] | None = None) -> int:
    """Typeset a file."""
    parser = argparse.ArgumentParser(prog="python -m tests.tools.typeset")
    parser.add_argument("table", type=Path, help="a .tex file with one table")
    parser.add_argument("picture", type=Path, help="the .png file to write")
    given = parser.parse_args(arguments)
    try:
        try:
            table = given.table.read_text(encoding="utf-8")
        except OSError as error:
            raise InputError(f"{given.table}: cannot be read ({error.strerror})") from None
        picture(table, given.picture)
    except InputError as error:
        print(f"typeset: {given.table}: {error}", file=sys.stderr)
        return 2
    print(given.picture)
    return 0


if __name__ == "__main__":
    sys.exit(main())
