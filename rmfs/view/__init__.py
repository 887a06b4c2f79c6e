"""The browser viewer: replays of recorded runs, and single files to send.

`scene` turns a run into the arrays a page draws, `container` is how they travel, `server` serves
them on loopback, `export` writes one file. The page is written in TypeScript (`web`); its tracked
build (`static`) is what is served, so that nobody needs Node to look at a run.
"""
