"""Scenarios of large plants that do not move, read without matrices of all states: what `garrison analyze` needs."""

from dataclasses import dataclass
from pathlib import Path

from garrison import _core
from garrison.objects import named
from garrison.scenario.model_file import read_static_plant
from garrison.scenario.network import read_network
from garrison.scenario.reader import read_document, read_title
from garrison.scenario.section import Section
from garrison.static_plant import StaticPlant

#: states from which rows stay sparse: below, dense matrices are fast enough, and more can be asked
LEAST = 500


@dataclass
class StaticScenario:
    """What an analysis needs of a scenario."""

    title: str
    plant: StaticPlant
    network: _core.Network
    names: list[str]  # of the agents


def read_static_scenario(path: str | Path) -> StaticScenario | None:
    """The scenario, where its model file holds a large plant that does not move; None: read_scenario() reads it.

    Raises IoError or InvalidInput.
    """
    path = Path(path)
    document = read_document(path)
    table = document.get("model")
    if not isinstance(table, dict) or set(table) != {"file"}:
        return None
    found = read_static_plant(Section("[model]", table, path.parent).file("file"), LEAST)
    if found is None:
        return None
    plant, names = found
    agents = len(names) if names else plant.agents
    ground = read_network(Section("[network]", document.get("network", {}), path.parent), names, agents)
    known = ground.names or names
    return StaticScenario(
        title=read_title(document, path),
        plant=plant,
        network=named(ground.network, known),
        names=known or [str(i) for i in range(agents)],
    )
