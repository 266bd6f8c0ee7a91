"""What a network withstands, what must not fail, and what to add: answers worked out by the core's searches."""

from garrison.answers.analysis import Analysis, analyze
from garrison.answers.limits import Limit
from garrison.answers.removals import Removal

__all__ = ["Analysis", "Limit", "Removal", "analyze"]
