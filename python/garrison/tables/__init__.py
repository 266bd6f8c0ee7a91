"""Tables of numbers in text files, as the world writes them: the one CSV reader of all commands.

The same reader with or without pandas installed, so that a file means the same everywhere.
"""

from garrison.tables.columns import Column, Table, read_table
from garrison.tables.matrix import read_matrix
from garrison.tables.records import Records, read_records
from garrison.tables.text import read_rows

__all__ = ["Column", "Records", "Table", "read_matrix", "read_records", "read_rows", "read_table"]
