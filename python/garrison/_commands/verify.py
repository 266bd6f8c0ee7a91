"""`garrison verify`: replay reference cases."""

import argparse
import math
import sys

from garrison._commands.terminal import NO, OK, REFUSED, Commands, console_for, print_json, print_table
from garrison.verify import FileResult, verify
from garrison.words import count


def add(commands: Commands) -> None:
    """Declare the command."""
    command = commands.add_parser("verify", help="replay reference cases; exit 1 on any miss", allow_abbrev=False)
    command.add_argument("folder", help="folder with case files (*.json), subfolders included; or one such file")
    command.add_argument("--family", help="only the cases of this family, e.g. saturation")
    command.add_argument("--fields", action="store_true", help="print every field, not only the misses")
    command.add_argument("--json", action="store_true", help="print JSON")
    command.set_defaults(do=do)


def _worst(result: FileResult) -> str:
    worst = max((f for f in result.fields if math.isfinite(f.deviation)), key=lambda f: f.deviation, default=None)
    return "-" if worst is None else f"{worst.deviation:.1e}  {worst.name}"


def do(args: argparse.Namespace) -> int:
    """Run the command."""
    results = verify(args.folder, args.family)
    fields = sum(len(r.fields) for r in results)
    misses = sum(r.misses for r in results)
    if args.json:
        print_json(
            {
                "files": [
                    {
                        "file": r.file,
                        "family": r.family,
                        "misses": r.misses,
                        "fields": [vars(f) for f in r.fields],
                    }
                    for r in results
                ],
                "fields": fields,
                "misses": misses,
            }
        )
    else:
        console = console_for()
        rows = [[r.file, r.family, str(len(r.fields)), _worst(r), str(r.misses)] for r in results]
        print_table("", ["file", "family", "fields", "worst deviation", "misses"], rows, console)
        for r in results:
            for f in r.fields:
                if not f.ok or args.fields:
                    far = f"{f.deviation:.2e} " if math.isfinite(f.deviation) else ""
                    console.print(f"{'ok  ' if f.ok else 'MISS'} {r.file} {f.name}: {far}{f.note}", markup=False)
    if not results:
        print(f"verify: no case files in {args.folder}", file=sys.stderr)
        return REFUSED
    print(
        f"verify: {count(len(results), 'file')}, {count(fields, 'field')}, {misses} missed",
        file=sys.stderr if args.json else sys.stdout,
    )
    return OK if misses == 0 else NO
