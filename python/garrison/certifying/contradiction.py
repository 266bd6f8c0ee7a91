"""What data say against the assumptions of certificates with memory, in words."""

import math

#: probability that a run whose noise is white is said to have noise that is not
FALSE = 1e-3
#: standard deviations of a rate beyond which it is not chance
_SURE = 4.0


def beyond(rate: float, samples: int, failure: float) -> bool:
    """Whether something that happens with probability `failure` in each of these samples happens too often."""
    return rate > failure + _SURE * math.sqrt(failure / samples)


def of_dependence(evidence: float, looked: int, where: str, correlation: float, pairs: float) -> list[str]:
    """A line where innovations are not independent; evidence: the largest of `looked` banks (Bank.dependence)."""
    if not evidence > math.log(looked / FALSE):
        return []
    return [
        f"innovations of the certificate with memory depend on those before them ({where}: correlation "
        f"{correlation:.2g} over {pairs:.0f} pairs; white noise has it said in fewer than one run of 1000): noise "
        "remembers its past, process_covariance or A is wrong, or more than `attacked` sources lie; bounds with memory "
        "may be wrong, see garrison.fit"
    ]


def of_apart(times: int, samples: int, first: int, where: str, failure: float) -> list[str]:
    """A line where the region with memory and that of a sample alone exclude each other; first: such a sample."""
    if not times or not beyond(times / samples, samples, failure):
        return []
    return [
        f"the region with memory and that of one sample alone have no point in common in {times} of {samples} samples, "
        f"first in sample {first} ({where}): process_covariance or A is wrong, noise remembers its past, or other "
        "sources lie than before; no region with memory is given there"
    ]
