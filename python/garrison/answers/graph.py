"""Links and agents whose loss alone cuts an undirected network in two."""

from dataclasses import dataclass

from garrison import _core


@dataclass(frozen=True)
class Cuts:
    """links: bridges, as (i, j) with i < j. agents: those whose loss parts the others. Both sorted."""

    links: list[tuple[int, int]]
    agents: list[int]


def cuts(network: _core.Network) -> Cuts:
    """By one depth-first search (Hopcroft, Tarjan, Communications of the ACM 1973)."""
    heard: list[list[int]] = [[] for _ in range(network.agents)]
    for i, j in network.edges:
        heard[i].append(j)
        heard[j].append(i)
    heard = [sorted(set(found)) for found in heard]
    order = [-1] * network.agents  # when an agent is found
    low = [0] * network.agents  # the earliest agent that it and those below it hear
    links: list[tuple[int, int]] = []
    agents: set[int] = set()
    count = 0
    for root in range(network.agents):
        if order[root] >= 0:
            continue
        stack = [(root, -1, iter(heard[root]))]
        order[root] = low[root] = count
        count += 1
        branches = 0
        while stack:
            at, parent, others = stack[-1]
            for other in others:
                if order[other] < 0:
                    order[other] = low[other] = count
                    count += 1
                    stack.append((other, at, iter(heard[other])))
                    break
                if other != parent:
                    low[at] = min(low[at], order[other])
            else:
                stack.pop()
                if parent < 0:
                    continue
                low[parent] = min(low[parent], low[at])
                if low[at] > order[parent]:
                    links.append((min(at, parent), max(at, parent)))
                if parent == root:
                    branches += 1
                elif low[at] >= order[parent]:
                    agents.add(parent)
        if branches > 1:
            agents.add(root)
    return Cuts(sorted(links), sorted(agents))
