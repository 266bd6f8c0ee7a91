"""`garrison design-file`: what is in a design file."""

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from garrison import _core
from garrison._commands.terminal import OK, Commands, print_json
from garrison.files import contents
from garrison.prepared import Prepared
from garrison.scenario.section import renamed
from garrison.words import count


def add(commands: Commands) -> None:
    """Declare the command."""
    command = commands.add_parser(
        "design-file", help="print what a design file holds, whole or one agent's part", allow_abbrev=False
    )
    command.add_argument("file", help="a file that Prepared.save wrote")
    command.add_argument("--show", action="store_true", help="list the gains as well")
    command.add_argument("--json", action="store_true", help="print JSON")
    command.set_defaults(do=do)


def do(args: argparse.Namespace) -> int:
    """Run the command."""
    data = contents(Path(args.file))
    summary = _summary(args.file, data)
    whole = summary["agent"] is None
    gains = Prepared.from_bytes(data).outline if args.show and whole else []
    if args.json:
        print_json({**summary, **({"gains": gains} if gains else {})})
        return OK
    whose = "the whole network" if whole else f"agent {summary['agent']} alone"
    print(f"{args.file}: design of {whose}, written by garrison {summary['garrison']}, {count(len(data), 'byte')}")
    print(f"hash    {summary['hash']}")
    print(f"filter  {summary['filter']}, {count(summary['agents'], 'agent')}, {count(summary['states'], 'state')}")
    for name, value in summary["params"].items():
        print(f"  {name} = {value}")
    if args.show and whole:
        _show_plant(Prepared.from_bytes(data))
    if args.show:
        print("gains" if whole else "the gains of one agent are listed by the design of the whole network")
    for line in gains:
        print(f"  {line}")
    return OK


def _summary(file: str, data: bytes) -> dict[str, Any]:
    try:
        return dict(_core.design_summary(data))
    except _core.Error as error:
        raise renamed(error, f"{file}:") from None


#: numbers in a matrix, and entries of a list, that are printed in full
_FULL, _LISTED = 64, 40


def _show_plant(prepared: Prepared) -> None:
    """The model and the network that the gains are for."""
    model, network = prepared.model, prepared.network
    print("model")
    print(f"  A = {_matrix(model.A)}")
    for agent, C in enumerate(model.C[:_LISTED]):
        print(f"  C[{agent}] = {_matrix(C)}")
    _more(len(model.C), "observation matrices")
    for what, names in (("states", model.state_names), ("outputs", model.output_names), ("agents", network.names)):
        if names:
            print(f"  {what}: {', '.join(names[:_LISTED])}")
            _more(len(names), what)
    kind = "directed, sender and receiver" if network.directed else "undirected"
    print(f"network, {kind}, {count(len(network.edges), 'edge')}")
    print(f"  {', '.join(f'{a}-{b}' for a, b in network.edges[:_LISTED])}")
    _more(len(network.edges), "edges")


def _matrix(values: Any) -> str:
    found = np.asarray(values)
    return str(found.tolist()) if found.size <= _FULL else f"{found.shape[0]} x {found.shape[1]} numbers"


def _more(length: int, what: str) -> None:
    if length > _LISTED:
        print(f"  ... and {length - _LISTED} more {what}")
