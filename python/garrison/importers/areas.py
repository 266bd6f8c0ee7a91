"""A grid divided into areas, and who talks to whom."""

from itertools import pairwise

import networkx as nx

from garrison.importers.grid_files import Grid


def graph_of(grid: Grid) -> "nx.Graph[int]":
    """Buses and branches."""
    graph: nx.Graph[int] = nx.Graph()
    graph.add_nodes_from(range(len(grid.names)))
    graph.add_edges_from((i, k) for i, k, _ in grid.branches)
    return graph


def areas_of(grid: Grid, chosen: list[int], count: int) -> list[list[int]]:
    """The chosen buses in `count` areas: each with the nearest of as many centres, which are far from each other."""
    graph = graph_of(grid)
    centres = [max(chosen, key=lambda b: (graph.degree[b], -b))]
    away = {b: float("inf") for b in graph}
    place = dict.fromkeys(graph, 0)
    while True:
        area = len(centres) - 1
        for b, hops in nx.single_source_shortest_path_length(graph, centres[-1]).items():
            if hops < away[b]:
                away[b], place[b] = hops, area
        if len(centres) == count:
            break
        centres.append(max(chosen, key=lambda b: (away[b], -b)))
    found = [[b for b in chosen if place[b] == area] for area in range(count)]
    return [one for one in found if one]


def links_of(grid: Grid, members: list[list[int]]) -> list[tuple[int, int]]:
    """Pairs of agents: those that a way through the grid joins without passing a bus of another agent."""
    graph = graph_of(grid)
    owner = {b: agent for agent, buses in enumerate(members) for b in buses}
    links = {_pair(owner[i], owner[k]) for i, k in graph.edges if i in owner and k in owner}
    free = graph.subgraph([b for b in graph if b not in owner])
    for part in nx.connected_components(free):
        around = sorted({owner[k] for b in part for k in graph[b] if k in owner})
        links |= {_pair(a, b) for a, b in pairwise(around)}
    return sorted(pair for pair in links if pair[0] != pair[1])


def _pair(a: int, b: int) -> tuple[int, int]:
    return min(a, b), max(a, b)
