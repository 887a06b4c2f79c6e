"""The browser viewer, which replays recorded runs, shows live ones, and exports single files.

`scene` turns a run into the arrays that the page draws, `container` packs them, `server` serves
them on the loopback interface, and `export` writes a single file. The page is written in TypeScript
(`web`); its build (`static`) is under version control, so that users do not need Node.
"""
