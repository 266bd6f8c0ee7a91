"""Cases of the platoon (section 3 of the cases' README): labels 1..N there, ids 0..N-1 here."""

import math
from typing import Any

import numpy as np

import garrison as gr
from garrison import _core
from garrison._core import platoon as theory
from garrison.verify.compare import NOT_UNDERSTOOD, RELATIVE, Array, Inputs, Within, numbers
from garrison.verify.platoon_formulas import pieces

NAME = "platoon"
#: relative tolerances other than the common one, by the end of the field's name
TOLERANCES = {"/l1": 1e-8}
#: properties of the data that need instrumentation
INFORMATIVE = frozenset({"smallest_decision_margin"})


_SETS = ("attacked", "suspected", "free")
#: switches that the cases fix; another value is another algorithm
_FIXED = {"gain_div": 0, "bound_div": 0, "test28": "xbar", "runs": "maximal", "tol": 1e-12}


def recognises(inputs: Inputs) -> bool:
    """Inputs that only this family has."""
    return bool({"y_rel", "n_rel", "spacing", "eta"} & inputs.keys()) and not {"A", "C"} & inputs.keys()


def _system(p: Inputs, recorded_inputs: bool = False) -> tuple[gr.Model, gr.Network]:
    return theory.model(p["N"], p["T"], recorded_inputs), gr.Network.band(p["N"], p["L"])


#: names of parameters -> letters of the case files, for messages
_LETTERS = {
    "process_noise": "eps",
    "measurement_noise": "mu",
    "initial_error": "q",
    "threshold": "beta",
    "attacked": "b",
    "period": "T",
    "vehicles": "N",
    "range": "L",
    "reference": "ref",
}


def _make(name: str, params: dict[str, Any]) -> _core.Filter:
    try:
        return gr.filters.make_filter(name, params)
    except _core.Error as error:
        letters = [letter for full, letter in _LETTERS.items() if full in str(error)]
        raise type(error)(f"{', '.join(letters)}: {error}" if letters else str(error)) from error


def _require_shapes(i: Inputs) -> None:
    """Refuses arrays whose shape does not follow from N and ref."""
    N, steps = i["params"]["N"], len(i["ref"])
    shapes: dict[str, tuple[int, ...]] = {"ref": (steps, 2), "x_init": (N, 2), "xhat_init": (N, 2), "w": (steps, N)}
    shapes |= {key: (steps, N, 2) for key in ("d", "n_abs", "a", "y_abs", "x")}
    shapes |= {key: (steps, N - 1, 2) for key in ("n_rel", "y_rel")} | {"u": (steps, N)}
    for key, shape in shapes.items():
        if key not in i:
            continue
        try:
            got: Any = numbers(i[key]).shape
        except (ValueError, TypeError):
            got = "rows of different lengths"
        if got != shape:
            raise _core.InvalidInput(f"{key}: got the shape {got}, expected {shape} for N = {N} and H = {steps - 1}")


def _steering(i: Inputs) -> dict[str, Any]:
    keys = {"spacing": "spacing", "gs": "gs", "gv": "gv"}
    found = {name: float(i[key]) for name, key in keys.items() if key in i}
    return found | {"reference": numbers(i["ref"]).ravel().tolist()}


def _pairs(sets: list[list[int]]) -> list[float]:
    return [float(v) for vehicle, labels in enumerate(sets) for label in labels for v in (vehicle, label - 1)]


def _filter(i: Inputs, **more: Any) -> _core.Filter:
    p = i["params"]
    for key, value in _FIXED.items():
        if p.get(key, value) != value:
            raise _core.InvalidInput(f"params.{key}: got {p[key]!r}, expected {value!r}, the only reading there is")
    given: dict[str, Any] = {
        "threshold": float(p["beta"]),
        "adaptive": p["threshold"] == "adaptive",
        "attacked": p["b"],
        "process_noise": float(p["eps"]),
        "measurement_noise": float(p["mu"]),
        "initial_error": float(p["q"]),
        "varpi": float(p["varpi"]),
        "detector": bool(p.get("detector", True)),
        "bound": p.get("bound", "safe"),
        "tie": p.get("tie", "low"),
        # A measurement that is not a number counts as an attack, as the cases of bad input want it.
        "accuse_missing": True,
    }
    sets0 = i.get("sets0", {})
    given |= {f"prior_{name}": _pairs(sets0[name]) for name in _SETS if any(sets0.get(name, []))}
    return _make("platoon", given | _steering(i) | more)


def _measurements(i: Inputs) -> Array:
    """Rows as garrison has them: absolute, relative and applied input, vehicle by vehicle."""
    y_abs, y_rel, u = (numbers(i[key]) for key in ("y_abs", "y_rel", "u"))
    rows = []
    for vehicle in range(y_abs.shape[1]):
        rows.append(y_abs[:, vehicle])
        if vehicle > 0:
            rows.append(y_rel[:, vehicle - 1])
        rows.append(u[:, vehicle, None])
    return np.hstack(rows)


def _replay(i: Inputs, **more: Any) -> gr.Run:
    """The recorded closed loop, observer alone."""
    model, net = _system(i["params"], recorded_inputs=True)
    return gr.replay(
        model,
        net,
        _filter(i, **more),
        measurements=_measurements(i),
        truth=numbers(i["x"]) if "x" in i else None,
        start=numbers(i["xhat_init"]),
        keep=("estimate", "report", "signals", "details"),
    )


def _disturbances(i: Inputs, attack: Array, factor: Array | None = None) -> Array:
    d, n_abs, n_rel = (numbers(i[key]) for key in ("d", "n_abs", "n_rel"))
    rows = np.zeros((*d.shape[:2], theory.DISTURBANCES))
    rows[..., 0:2] = d
    rows[..., 2:4] = n_abs + attack
    rows[..., 4] = 0.0 if factor is None else factor
    rows[:, 1:, 5:7] = n_rel
    return rows.reshape(len(d), -1)


def _closed_loop(i: Inputs, filter: _core.Filter, noise: Array, attack: Any = ()) -> gr.Run:
    model, net = _system(i["params"])
    return gr.simulate(
        model,
        net,
        filter,
        steps=len(noise) - 1,
        x0=numbers(i["x_init"]),
        start=numbers(i["xhat_init"]),
        noise=noise,
        attack=attack,
        keep=("estimate", "report", "signals", "measurements", "details"),
    )


def _labels(ids: list[float]) -> list[int]:
    return [int(v) + 1 for v in ids]


def _set_changes(run: gr.Run) -> list[dict[str, Any]]:
    """The three sets of a vehicle whenever one of them changed."""
    N = run.network.agents
    now: list[dict[str, list[int]]] = [{name: [] for name in _SETS} for _ in range(N)]
    changed: dict[tuple[int, int], bool] = {}
    out: list[dict[str, Any]] = []
    for _, t, vehicle, name, values in run.details:
        if name not in _SETS:
            continue
        now[vehicle] = now[vehicle] | {name: _labels(values)}
        if (t, vehicle) in changed:
            out[-1] |= now[vehicle]
        else:
            changed[t, vehicle] = True
            out.append({"t": t, "vehicle": vehicle + 1, **now[vehicle]})
    return out


def _members(run: gr.Run, name: str) -> set[int]:
    return {label for entry in _set_changes(run) for label in entry[name]}


def _bound_holds(run: gr.Run) -> bool:
    assert run.error is not None
    return bool((run.error[0] <= run.signals["alpha"][0]).all())


def _threshold(beta: float) -> Within:
    """Without noise the reference's falls to 1e-17; ours keeps what rounding can add to an error of 200 m."""
    return Within(float(beta), RELATIVE * abs(float(beta)) + 1e-11)


def _per_time(run: gr.Run) -> dict[str, Any]:
    """K, beta and J: one object per time, keys are labels."""
    steps, N = run.signals["alpha"].shape[1:]
    gains: dict[int, list[float]] = {}
    K: list[dict[str, Any]] = [{} for _ in range(steps)]
    entries = iter([d for d in run.details if d[3] == "gains"])
    entry = next(entries, None)
    for t in range(1, steps):
        while entry is not None and entry[1] <= t:
            gains[entry[2]] = entry[4]
            entry = next(entries, None)
        K[t] = {str(vehicle + 1): gains[vehicle] for vehicle in sorted(gains)}
    beta, source = run.signals["threshold"][0], run.signals["source"][0]
    out_beta: list[dict[str, Any]] = [{} for _ in range(steps)]
    J: list[dict[str, Any]] = [{} for _ in range(steps)]
    for t in range(1, steps):
        out_beta[t] = {str(v + 1): _threshold(beta[t, v]) for v in range(N) if not math.isnan(beta[t, v])}
        J[t] = {str(v + 1): int(source[t, v]) + 1 for v in range(N) if source[t, v] >= 0}
    return {"K": K, "beta": out_beta, "J": J}


def _of_run(i: Inputs, run: gr.Run) -> dict[str, Any]:
    """Everything of one run under the names of the case files."""
    assert run.estimate is not None
    s = run.signals
    out: dict[str, Any] = {
        "xbar": np.stack([s["prediction_position"][0], s["prediction_velocity"][0]], axis=2),
        "xhat": run.estimate[0],
        "alpha": s["alpha"][0],
        "u": s["control"][0],
        "set_changes": _set_changes(run),
        **_per_time(run),
    }
    attacked = set(i.get("attacked_set", []))
    N = run.network.agents
    out["false_attacked"] = bool(_members(run, "attacked") - attacked)
    out["false_free"] = bool(_members(run, "free") & attacked)
    if run.error is not None and run.truth is not None:
        out["bound_holds_everywhere"] = _bound_holds(run)
        ref = numbers(i["ref"])
        desired = ref[:, None, :] - np.arange(N)[None, :, None] * np.array([float(i["spacing"]), 0.0])
        tracking = np.linalg.norm(run.truth[0] - desired, axis=2)
        out["phi"] = run.error[0].mean(axis=1) + tracking.mean(axis=1)
        out["within_bound"] = (run.error[0], s["alpha"][0])
    return out


def _measured(run: gr.Run) -> dict[str, Any]:
    """What a closed loop recorded: y_abs, y_rel, x under the names of the inputs."""
    assert run.measurements is not None and run.truth is not None
    y, N = run.measurements[0], run.network.agents
    at = [0, *(2 + 4 * k for k in range(N - 1))]
    return {
        "x": run.truth[0],
        "y_abs": np.stack([y[:, a : a + 2] for a in at], axis=1),
        "y_rel": np.stack([y[:, a + 2 : a + 4] for a in at[1:]], axis=1),
    }


def _other(i: Inputs, expected: dict[str, Any], main: gr.Run) -> dict[str, Any]:
    run = _replay(i, bound=expected.get("bound", "printed"))
    assert run.estimate is not None
    changes, same = _set_changes(run), _set_changes(main)
    return {
        "bound": run.filter.params["bound"],
        "alpha": run.signals["alpha"][0],
        "set_changes": "same" if changes == same else changes,
        "false_attacked": bool(_members(run, "attacked") - set(i.get("attacked_set", []))),
        "false_free": bool(_members(run, "free") & set(i.get("attacked_set", []))),
        "bound_holds_everywhere": _bound_holds(run) if run.error is not None else NOT_UNDERSTOOD,
        "xhat_end": run.estimate[0, -1],
        "xhat": run.estimate[0],
    }


def _loop(i: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    noises = {"d", "n_abs", "n_rel", "x_init"} <= i.keys()
    recorded = {"y_abs", "y_rel", "u"} <= i.keys()
    if noises:
        a = numbers(i["a"]) if "a" in i else np.zeros_like(numbers(i["n_abs"]))
        run = _closed_loop(i, _filter(i), _disturbances(i, a))
        out = _of_run(i, run)
        if recorded and not _agrees(i, run):
            raise _core.InvalidInput("y_abs, y_rel, u: the closed loop does not reproduce what was recorded")
    else:
        run = _replay(i)
        out = _of_run(i, run)
    other = expected.get("other_bound_on_same_data")
    if isinstance(other, dict):
        out["other_bound_on_same_data"] = _other(i, other, run)
    return out


def _agrees(i: Inputs, run: gr.Run) -> bool:
    """The closed loop gives the recorded data: the vehicles of the library move as those of the case."""
    got = _measured(run) | {"u": run.signals["control"][0]}
    for key in ("y_abs", "y_rel", "u", "x"):
        if key not in i:
            continue
        wanted = numbers(i[key])
        known = np.isfinite(wanted) & np.isfinite(got[key])
        scale = float(np.abs(wanted[known]).max(initial=0.0))
        if float(np.abs(got[key] - wanted)[known].max(initial=0.0)) > 1e-9 * scale + 1e-12:
            return False
    return True


_ATTACKS = {
    "dos": lambda ids: gr.attacks.Scale(agents=ids, factor=0.0, start=0),
    "bias": lambda ids: gr.attacks.Bias(agents=ids, value=100.0, start=0),
    "replay": lambda ids: gr.attacks.Replay(agents=ids, delay=10, start=12),
}


def _baselines(i: Inputs, expected: dict[str, Any]) -> dict[str, Any]:
    out: dict[str, Any] = {}
    p = i["params"]
    ids = [label - 1 for label in i.get("attacked_set", [])]
    factor = None
    attack: Any = ()
    a = numbers(i["a"]) if "a" in i else np.zeros_like(numbers(i["n_abs"]))
    if "w" in i and i.get("kind", "random") == "random":
        factor = np.zeros_like(numbers(i["w"]))
        factor[:, ids] = numbers(i["w"])[:, ids]
    elif "a" not in i and i.get("kind") is not None:
        if str(i["kind"]).lower() not in _ATTACKS:
            return {name: NOT_UNDERSTOOD for name in expected}
        attack = [_ATTACKS[str(i["kind"]).lower()](ids)] if ids else ()
    noise = _disturbances(i, a, factor)
    for name in expected:
        if name not in ("PWM", "PBE", "PTD"):
            continue
        given = {"kind": name.lower(), "attacked": p["b"], "varpi": float(p["varpi"])}
        filter = _make("platoon_baseline", given | _steering(i))
        run = _closed_loop(i, filter, noise, attack)
        assert run.truth is not None and run.estimate is not None
        out[name] = {"x": run.truth[0], "u": run.signals["control"][0], "xhat": run.estimate[0]}
    return out


def evaluate(inputs: Any, expected: Any) -> Any:
    """Recompute every expected field from the inputs; keys that are not known stay away."""
    if isinstance(inputs, list):
        return [evaluate(i, e) for i, e in zip(inputs, expected, strict=True)]
    out = pieces(inputs, expected)
    if "params" not in inputs or "ref" not in inputs:
        return out
    _require_shapes(inputs)
    if {"PWM", "PBE", "PTD"} & expected.keys():
        out |= _baselines(inputs, expected)
    if {k for k in expected if k not in out}:
        out |= {k: v for k, v in _loop(inputs, expected).items() if k not in out}
    return out


def use(inputs: Inputs, template: dict[str, Any], scope: str | None) -> None:
    """Use the inputs as the template does, and let any refusal through."""
    evaluate(inputs, template.get("expected", {"xhat": None}))


def survive(inputs: Inputs, template: dict[str, Any], paths: list[str]) -> dict[str, Any]:
    """Outputs of a case that has to be survived, for the paths that its rules look at."""
    _require_shapes(inputs)
    run = _closed_loop(inputs, _filter(inputs), _disturbances(inputs, numbers(inputs["a"])))
    out = _of_run(inputs, run)
    # bad.py reads an error and its bound, and the accused under `sets`.
    attacked: dict[int, list[int]] = {}
    changes = []
    for change in out["set_changes"]:
        attacked[change["vehicle"]] = change["attacked"]
        changes.append({"t": change["t"], "sets": list(attacked.values())})
    return out | {"set_changes": changes}


__all__ = ["NAME", "NOT_UNDERSTOOD", "TOLERANCES", "evaluate", "recognises", "survive", "use"]
