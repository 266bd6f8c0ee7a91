"""`python -m garrison`: the command line."""

import sys

from garrison.cli import main

sys.exit(main())
