"""What people read of a run: its table, and one self-contained HTML page (the page needs the extra plot)."""

from garrison.report.table import table_rows

__all__ = ["table_rows"]
