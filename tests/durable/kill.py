"""kill.py - kill -9 at any moment."""


def prove(run):
    del run
