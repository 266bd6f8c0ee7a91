"""All families and baselines against all attacks on one plant: one table, one picture."""

from garrison.comparison.run import Comparison, compare

__all__ = ["Comparison", "compare"]
