"""The files of the built page, to be served or combined into one file."""

from __future__ import annotations

import base64
import hashlib
from pathlib import Path

STATIC = Path(__file__).resolve().parent / "static"

FILES = {
    "/": ("index.html", "text/html; charset=utf-8"),
    "/app.js": ("app.js", "text/javascript; charset=utf-8"),
    "/app.css": ("app.css", "text/css; charset=utf-8"),
}
"""The only files that are served: name and media type, by path of the request."""

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
"""Content security policy of the served page, which permits no external content."""


def content(name: str) -> bytes:
    """Return the content of a file of the build."""
    return (STATIC / name).read_bytes()


def single_file(scenes: list[bytes]) -> bytes:
    """Return the page as one file with script, style and scenes.

    The content security policy of the file permits no other script or style, and no connection.

    Parameters
    ----------
    scenes
        Packed scenes, one per run, compressed by gzip.
    """
    script = content("app.js").replace(b"</script", b"<\\/script")
    style = content("app.css")
    policy = (
        f"default-src 'none'; script-src '{_hash(script)}'; style-src '{_hash(style)}'; "
        "img-src data: blob:; base-uri 'none'; form-action 'none'"
    )
    parts = [
        b'<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n',
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">\n'.encode(),
        b'<meta name="viewport" content="width=device-width, initial-scale=1">\n',
        b'<link rel="icon" href="data:,">\n<title>rmfs</title>\n<style>',
        style,
        b"</style>\n</head>\n<body>\n",
    ]
    for scene in scenes:
        parts += [
            b'<script type="application/octet-stream" data-scene>',
            base64.b64encode(scene),
            b"</script>\n",
        ]
    return b"".join([*parts, b'<script type="module">', script, b"</script>\n</body>\n</html>\n"])


def _hash(text: bytes) -> str:
    return f"sha256-{base64.b64encode(hashlib.sha256(text).digest()).decode()}"
