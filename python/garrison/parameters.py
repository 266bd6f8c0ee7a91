"""Parameters of filters and attacks as people write them, brought to the types that the core takes."""

from typing import Any

import numpy as np

from garrison.numeric import numbers, real
from garrison.words import only, refusal, shown


def cleaned(where: str, infos: list[dict[str, Any]], given: dict[str, Any]) -> dict[str, Any]:
    """`given` with unambiguous values converted: 3.0 for a whole number, a number for a text, nested lists for flat.

    infos: descriptions of the parameters, from the core. Ranges are left to the core. Raises InvalidInput for unknown
    names, with the nearest one, and for values of another kind.
    """
    known = {info["name"]: info for info in infos}
    only(where, given, known)
    return {
        name: _converted(f"{where}.{name}", known[name], value) for name, value in given.items() if value is not None
    }


def _converted(where: str, info: dict[str, Any], value: Any) -> Any:
    default = info["default"]
    value = value.item() if isinstance(value, (np.generic, np.ndarray)) and np.ndim(value) == 0 else value
    if isinstance(default, bool):
        if isinstance(value, bool):
            return value
        raise refusal(where, shown(value), "true or false", info["doc"])
    if isinstance(default, str):
        if isinstance(value, str):
            return value
        if isinstance(value, (int, float)) and not isinstance(value, bool) and not info["choices"]:
            return repr(value)
        words = f"one of {', '.join(info['choices'])}" if info["choices"] else "a string"
        raise refusal(where, shown(value), words, info["doc"])
    if isinstance(default, list):
        return numbers(where, value).ravel().tolist()
    if (found := real(value)) is None:
        raise refusal(where, shown(value), "a number", info["doc"])
    return value if abs(found) < 2.0**63 else found
