"""Controllers that use models: they ask optimisers questions, and turn the answers into decisions.

A question is a decision problem at one instant, stated as the input of a model.
"""
