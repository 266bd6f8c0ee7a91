"""All families and baselines against all attacks on one plant: one table, one picture."""

from garrison.comparison.run import compare
from garrison.comparison.table import Comparison

__all__ = ["Comparison", "compare"]
