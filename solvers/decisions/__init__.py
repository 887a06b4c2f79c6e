"""Decisions as files: questions to optimisers that travel, and everything done with them.

`schema` says what a question and its answer consist of, `files` reads and writes them, `recording`
takes them down in a run, `checking` verifies answers without the models, `solving` asks the models,
`exact` hands their formulations to any solver. The format is docs/decision-format.md, its use
docs/decisions.md.
"""
