"""`python -m garrison.net`: the command `garrison-net`."""

import sys

from garrison.net.command import main

sys.exit(main())
