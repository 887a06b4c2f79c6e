"""Decisions as files: questions saved in runs, then solved, checked and compared without a run.

`schema` defines the fields of questions and answers, `files` reads and writes them, `recording`
saves them during a run, `checking` verifies answers without the models, `solving` solves them with
the models, and `exact` exports exact formulations for any solver. The format is described in
docs/decision-format.md, its use in docs/decisions.md.
"""
