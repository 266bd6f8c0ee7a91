"""`python -m garrison.net.web`: the command `garrison-web`."""

import sys

from garrison.net.web.command import main

sys.exit(main())
