"""What is measured, row by row, with the bar of each: `garrison-net accept`."""

from garrison.net.accept import daemons, programs
from garrison.net.accept.row import Row

#: Cheap ones first.
ROWS: tuple[Row, ...] = (*programs.QUICK, *daemons.ROWS, *programs.LONG)
