"""The IEEE 118-bus power grid as a system to be watched: structure, and which sensors are necessary.

    pip install garrison[grid]
    python examples/grid/ieee118.py -o out/grid

The network is pandapower's `case118`. Model: the structure-preserving swing equations (Bergen, Hill 1981), linearised
at equal angles: a generator's rotor has an angle and a frequency, a bus without one a frequency-dependent load,

    M w' = -D w - sum_j b_ij (th_i - th_j),  th' = w     |     D th' = -sum_j b_ij (th_i - th_j),

b_ij the series susceptance of the lines, in steps of 2 ms by the symplectic Euler rule (frequencies first), which keeps
the zeros of the grid and is stable. States: 118 angles, then the generators' frequencies. Agents: phasor units at the
ten buses with most lines, each hearing those at most four lines away, and the nearest.
"""

import argparse
from pathlib import Path
from typing import Any

import garrison as gr
import networkx as nx
import numpy as np
from garrison.anatomy import Anatomy, table_rows
from garrison.figures import anatomy_figure
from rich.console import Console
from rich.table import Table

STEP = 0.002  # s
INERTIA, ROTOR_DAMPING, LOAD_DAMPING = 0.2, 0.05, 1.0  # per unit power, s^2, s, s


def grid() -> nx.Graph:
    """Buses 0..117 and lines with their susceptance; `generator` on the nodes."""
    try:
        import pandapower.networks
    except ImportError:
        raise SystemExit('The network is pandapower\'s, which is not installed: pip install "garrison[grid]"') from None

    net: Any = pandapower.networks.case118()
    graph = nx.Graph()
    graph.add_nodes_from(range(len(net.bus)))
    ohm = net.bus.vn_kv.to_numpy() ** 2 / net.sn_mva  # base impedance
    for line in net.line.itertuples():
        x = line.x_ohm_per_km * line.length_km / line.parallel / ohm[line.from_bus]
        _add(graph, line.from_bus, line.to_bus, 1.0 / x)
    for trafo in net.trafo.itertuples():
        x = trafo.vk_percent / 100.0 * net.sn_mva / trafo.sn_mva / trafo.parallel
        _add(graph, trafo.hv_bus, trafo.lv_bus, 1.0 / x)
    generators = set(net.gen.bus) | set(net.ext_grid.bus)
    nx.set_node_attributes(graph, {b: b in generators for b in graph}, "generator")
    return graph


def _add(graph: nx.Graph, a: int, b: int, susceptance: float) -> None:
    before = graph.get_edge_data(a, b, {"susceptance": 0.0})["susceptance"]
    graph.add_edge(int(a), int(b), susceptance=before + susceptance)


def system_matrix(graph: nx.Graph) -> np.ndarray:
    """One sample of the linearised grid."""
    buses = len(graph)
    rotors = [b for b in graph if graph.nodes[b]["generator"]]
    n = buses + len(rotors)
    A = np.zeros((n, n))
    for b in graph:
        pull = {c: graph[b][c]["susceptance"] for c in graph[b]}
        pull[b] = -sum(pull.values())
        A[b, b] = 1.0
        if graph.nodes[b]["generator"]:
            w = buses + rotors.index(b)
            A[w, w] = 1.0 - STEP * ROTOR_DAMPING / INERTIA
            for c, strength in pull.items():
                A[w, c] = STEP / INERTIA * strength
            A[b] += STEP * A[w]
        else:
            for c, strength in pull.items():
                A[b, c] += STEP / LOAD_DAMPING * strength
    return A


def sensors(graph: nx.Graph, count: int = 10) -> tuple[list[int], list[tuple[int, int]]]:
    """The buses with most lines, and who hears whom."""
    buses = sorted(graph, key=lambda b: (-graph.degree[b], b))[:count]
    hops = dict(nx.all_pairs_shortest_path_length(graph))
    network = nx.minimum_spanning_tree(
        nx.from_edgelist([(i, j, {"weight": hops[buses[i]][buses[j]]}) for i in range(count) for j in range(i)])
    )
    near = [(i, j) for i in range(count) for j in range(i) if hops[buses[i]][buses[j]] <= 4]
    return buses, sorted({(max(e), min(e)) for e in [*network.edges, *near]})


def main() -> dict[str, Any]:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", default="out/grid", help="folder for the picture")
    args = parser.parse_args()
    folder = Path(args.output)
    folder.mkdir(parents=True, exist_ok=True)
    graph = grid()
    A = system_matrix(graph)
    buses, links = sensors(graph)
    net = gr.Network(links, agents=len(buses))
    C = np.eye(len(A))[buses]
    names = [f"bus {b + 1}" for b in buses]
    anatomy = Anatomy("IEEE 118-bus grid, phasor units at ten buses", A, [[b] for b in buses], names, net)
    anatomy.undetectable = gr.structure.undetectable_agents(gr.Model(A, C))
    report = anatomy.report()
    report["spectral_radius_of_A"] = float(np.abs(np.linalg.eigvals(A)).max())
    anatomy_figure(anatomy).savefig(folder / "ieee118.png", dpi=120)
    console = Console(width=140)
    console.print(
        f"{report['states']} states, structural rank {report['structural_rank']}, {report['components']} strong "
        f"component(s), {len(report['parent_components'])} of them a parent, "
        f"rho(A) = {report['spectral_radius_of_A']:.6f}"
    )
    table = Table(title="phasor units", title_justify="left")
    for head in ("agent", "measures", "class", "necessary", "substitutes", "could drift unseen"):
        table.add_column(head, overflow="fold")
    for row in table_rows(report):
        table.add_row(*row)
    console.print(table)
    console.print(f"picture in {folder}")
    return report


if __name__ == "__main__":
    main()
