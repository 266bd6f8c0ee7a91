"""Certificates of runs: options, arrays, words, files, scenarios."""

import csv
import json
import pickle
from pathlib import Path
from typing import Any

import garrison as gr
import numpy as np
import pytest
from conftest import ROOT
from garrison.cli import main
from garrison.scenario import read_scenario

NAMES = ("truth", "bound", "bound_kind", "published")


def parts(agents: int = 8) -> tuple[gr.Model, gr.Network, gr.Filter]:
    model = gr.Model(
        [[0.98, 0.1], [0.0, 0.95]],
        [[1, 0], [0, 1]] * (agents // 2),
        process_bound=0.03,
        measurement_bound=0.05,
        process_covariance=1e-4 * np.eye(2),
        measurement_covariance=[[[4e-4]]] * agents,
    )
    network = gr.Network([(i, (i + k) % agents) for i in range(agents) for k in (1, 2)], agents=agents)
    return model, network, gr.filters.ScalarGain(rounds=4)


@pytest.mark.parametrize("certificate", ["local", "flooded", "direct"])
@pytest.mark.parametrize("failure", [0.0, 1e-6])
def test_a_bound_that_holds_although_sensors_lie_and_messages_are_lost(certificate: str, failure: float) -> None:
    attack = gr.attacks.Bias(agents=[2], value=7.0, start=5)
    plain = gr.simulate(*parts(), steps=60, attack=attack, trials=5, link={"drop": 0.2}, conditions=False)
    run = gr.simulate(
        *parts(),
        steps=60,
        attack=attack,
        trials=5,
        link={"drop": 0.2},
        conditions=False,
        certificate=certificate,
        failure=failure,
        attacked=1,
    )
    assert np.array_equal(run.estimate, plain.estimate)
    assert np.isnan(plain.bound).all() and (plain.bound_kind == gr.BoundKind.NONE).all() and plain.published is None
    assert np.isnan(run.published).all()
    late = run.bound[:, 10:]
    assert np.isfinite(late).all()
    assert (run.error <= run.bound)[:, 10:].all()
    assert set(np.unique(run.bound_kind[:, 10:])) <= {gr.BoundKind.WITNESS, gr.BoundKind.RELAYED}
    assert run.bytes_per_step > plain.bytes_per_step


def test_every_absent_bound_says_why() -> None:
    model, network, scalar = parts()
    y = np.zeros((3, 8))
    y[0, 1:] = np.nan
    y[2, :4] = 9.0
    run = gr.replay(model, network, scalar, measurements=y, certificate="flooded", failure=0.0, attacked=1)
    assert np.isinf(run.bound[0, 0, 0]) and "too few measurements" in run.why_no_bound(0, 1)
    assert run.why_no_bound(0, 2) == ""
    assert np.isnan(run.bound[0, 3, 0]) and "contradict" in run.why_no_bound(agent=0, time=3)
    assert "no certificate was asked for" in gr.replay(model, network, scalar, measurements=y).why_no_bound(0, 1)
    lying = gr.attacks.Forge(agents=[0], offset=1.0, start=1)
    lied = gr.replay(model, network, scalar, measurements=y, certificate="local", failure=0.0, attacked=1, attack=lying)
    assert "lie in their messages" in lied.why_no_bound(3, 2)
    with pytest.raises(gr.InvalidInput, match=r"time: got 4, expected a whole number in 0\.\.3"):
        run.why_no_bound(0, 4)


def test_direct_certificates_hold_although_agents_lie_in_their_messages() -> None:
    lies = [gr.attacks.Forge(agents=[0, 1, 2], offset=5.0, start=1), gr.attacks.Bias(agents=[0], value=5.0, start=1)]
    asked = {"steps": 40, "attack": lies, "conditions": False, "failure": 0.0, "attacked": 1}
    direct = gr.simulate(*parts(), certificate="direct", **asked)
    assert np.isfinite(direct.bound[:, 1:]).all() and (direct.error <= direct.bound)[:, 1:].all()
    assert set(np.unique(direct.bound_kind[:, 1:])) <= {gr.BoundKind.WITNESS, gr.BoundKind.RELAYED}
    local = gr.simulate(*parts(), certificate="local", **asked)
    assert np.isnan(local.bound).all() and "direct" in local.why_no_bound(0, 5)


def test_direct_certificates_hold_whatever_is_said_for_them() -> None:
    """A liar shows every neighbour another measurement, or none, in every round of random systems and links."""
    told = absent = 0
    for seed in range(30):
        rng = np.random.default_rng(seed)
        agents, liar = int(rng.integers(5, 9)), int(rng.integers(0, 5))
        model = gr.Model(
            0.95 * np.linalg.qr(rng.normal(size=(2, 2)))[0],
            [rng.normal(size=(1, 2)) for _ in range(agents)],
            process_bound=0.02,
            measurement_bound=0.05,
        )
        network = gr.Network.complete(agents)

        def lie(
            t: int, round: int, sender: int, receiver: int, message: dict[str, Any], rng: np.random.Generator
        ) -> dict[str, Any]:
            size = 10.0 ** rng.uniform(-2, 6)
            said = message["certificate.measurements"] + size * rng.normal()
            return {"certificate.measurements": said if rng.random() < 0.8 else np.full_like(said, np.nan)}

        run = gr.simulate(
            model,
            network,
            gr.filters.ScalarGain(rounds=2),
            steps=30,
            attack=gr.attacks.custom_message(lie, [liar], start=1),
            link={"drop": 0.2},
            certificate="direct",
            failure=0.0,
            attacked=1,
            seed=seed,
            conditions=False,
        )
        honest = [i for i in range(agents) if i != liar]
        bound, error = run.bound[:, :, honest], run.error[:, :, honest]
        assert run.counters["forged"] > 0
        assert not (error > bound).any()
        told += int(np.isfinite(bound).sum())
        absent += int((~np.isfinite(bound)).sum())
    assert told > absent


@pytest.mark.parametrize("certificate", ["local", "flooded"])
def test_liars_reach_all_that_is_said_for_a_certificate(certificate: str) -> None:
    asked: dict[str, Any] = {"steps": 5, "certificate": certificate, "failure": 0.0, "attacked": 1, "conditions": False}
    for field, value, counted in (
        ("certificate.measurements", 9.0, "forged"),
        ("certificate.ball", 0.0, "forged"),
        ("certificate.age", 2.0, "forged"),
        ("certificate.fresh", -1.0, "refused"),
    ):
        lie = gr.attacks.Falsify([0], field=field, value=value)
        run = gr.simulate(*parts(), attack=lie, **asked)
        assert run.counters[counted] > 0 and np.isnan(run.bound).all()
    with pytest.raises(gr.InvalidInput, match=r"certificate\.age, certificate\.fresh"):
        gr.simulate(*parts(), attack=gr.attacks.Falsify([0], field="certificate.agee", value=1.0), **asked)


def test_the_data_free_table_bounds_where_the_published_bound_ends() -> None:
    model, network, _ = parts()
    options = {"threshold": 1.0, "rounds": 12, "attacked": 1, "initial_error": 2.0, "detector": True}
    attack = gr.attacks.Bias(agents=[2], value=90.0, start=5)
    told = {"steps": 30, "attack": attack, "conditions": False}
    plain = gr.simulate(model, network, gr.filters.Saturation(**options), **told)
    table = gr.filters.Saturation(**options, table=True)
    run = gr.simulate(model, network, table, **told)
    assert (run.bound_kind[0, 5] == gr.BoundKind.TABLE).all()  # the attacker is proved in this sample
    assert np.isnan(plain.bound[0, 10:]).all() and (run.bound_kind[0, 10:] == gr.BoundKind.INFORMED).all()
    assert (run.error <= run.bound).all()
    table_bound = gr.check(model, network, table)["table bound"]
    assert run.bound[0, -1].max() < table_bound
    calm = gr.simulate(model, network, table, steps=200, conditions=False)
    assert (calm.bound_kind[0, -1] == gr.BoundKind.TABLE).all()
    assert table_bound == pytest.approx(calm.bound[0, -1].max(), rel=2e-3)


def test_bounds_and_tests_go_on_after_lost_messages_and_agents_of_messages_have_the_same_bits() -> None:
    model, network, _ = parts()
    options = {"threshold": 1.0, "rounds": 12, "attacked": 1, "initial_error": 2.0, "detector": True, "table": True}
    attack = gr.attacks.Bias(agents=[2], value=90.0, start=40)
    told: dict[str, Any] = {"steps": 60, "attack": attack, "conditions": False, "link": {"cuts": [(5, None, 10, 14)]}}
    ended = gr.simulate(model, network, gr.filters.Saturation(**options), **told)
    assert np.isnan(ended.bound[0, 20:]).all()
    assert not any(s for _, _, sets in ended.accusations for s in sets)
    filt = gr.filters.Saturation(**options, recovery=True)
    run = gr.simulate(model, network, filt, **told)
    assert (run.bound_kind[0, 14:] == gr.BoundKind.RECOVERED).all()
    assert (run.error <= run.bound).all()
    assert run.bound[0, -1].max() < 1.01 * gr.check(model, network, filt)["table bound"]
    assert all(2 in s for s in run.accusations[-1][2])


def test_a_bound_for_fewer_liars_does_not_stand_in_for_the_certificate() -> None:
    """One of eight lies; the filter was told of none, the certificate of one."""
    model, network, _ = parts()
    filt = gr.filters.Saturation(threshold=50.0, rounds=12, attacked=0, initial_error=2.0)
    lie = gr.attacks.Bias(agents=[0], value=40.0)
    options = {"steps": 60, "attack": lie, "certificate": "flooded", "failure": 0.0, "seed": 3}
    run = gr.simulate(model, network, filt, attacked=1, **options)
    assert run.error is not None and run.bound is not None and run.published is not None
    assert (run.error[:, 1:] > run.published[:, 1:]).any()  # what it says holds without liars
    assert (run.error[:, 1:] <= run.bound[:, 1:]).all()
    assert (run.bound_kind != gr.BoundKind.PUBLISHED).all()


def test_the_published_bound_is_kept_beside_the_better_one() -> None:
    model, network, _ = parts()
    filt = gr.filters.Saturation(threshold=1.0, rounds=12, attacked=1, initial_error=2.0, chebyshev=True)
    plain = gr.simulate(model, network, filt, steps=10, conditions=False)
    run = gr.simulate(model, network, filt, steps=10, conditions=False, certificate="flooded")  # attacked: the filter's
    assert np.array_equal(run.published, plain.bound, equal_nan=True)
    assert (run.bound[0, 1:] <= plain.bound[0, 1:]).all()
    assert run.bound_kind[0, 0, 0] == gr.BoundKind.PUBLISHED  # no sample yet
    assert run.bound_kind[0, 5, 0] == gr.BoundKind.WITNESS


def test_designs_agents_and_runs_keep_it(tmp_path: Path) -> None:
    net = gr.prepare(*parts(), certificate="flooded", failure=1e-3, attacked=1)
    assert net.certificate == {"certificate": "flooded", "failure": 1e-3, "attacked": 1}
    assert gr.prepare(*parts()).certificate is None
    assert eval(repr(net), {"garrison": gr}) == net
    net.save(tmp_path / "net.gdesign")
    again = gr.Prepared.load(tmp_path / "net.gdesign")
    assert again == net and again.certificate == net.certificate and again != gr.prepare(*parts())
    run = again.simulate(steps=6, seed=2, conditions=False)
    agents = [gr.Agent.from_part(again.part(i)) for i in range(8)]
    for t in range(1, 7):
        messages = [a.sense(t, [run.measurements[0, t - 1, a.id]]) for a in agents]
        for _ in range(agents[0].rounds):
            messages = [a.fuse([messages[j] for j in a.neighbours]) for a in agents]
        assert [a.bound for a in agents] == list(run.bound[0, t])
        assert [a.bound_kind for a in agents] == list(run.bound_kind[0, t])
    said = messages[0].fields
    assert {"certificate.measurements", "certificate.ball", "certificate.age", "certificate.fresh"} <= set(said)
    run.save(tmp_path / "run.npz")
    assert gr.Run.load(tmp_path / "run.npz") == run == pickle.loads(pickle.dumps(run))
    with pytest.raises(gr.InvalidInput, match="certificate: got 'local' with a design"):
        net.simulate(steps=3, certificate="local", attacked=1)


def test_slips_are_refused_by_name() -> None:
    with pytest.raises(gr.InvalidInput, match="attacked: got no value, with certificate 'local'"):
        gr.prepare(*parts(), certificate="local")
    with pytest.raises(gr.InvalidInput, match=r"certificate.*floded.*flooded"):
        gr.prepare(*parts(), certificate="floded", attacked=1)
    with pytest.raises(gr.InvalidInput, match="failure: got 2, expected a probability"):
        gr.prepare(*parts(), certificate="local", failure=2, attacked=1)
    with pytest.raises(gr.InvalidInput, match="attacked: got 8, expected less than the number of sources, 8"):
        gr.prepare(*parts(), certificate="local", attacked=8)
    bare = gr.Model([[1.0]], [[1]] * 3)
    with pytest.raises(gr.InvalidInput, match="measurement_covariance"):
        gr.prepare(bare, gr.Network.ring(3), gr.filters.ScalarGain(), certificate="local", attacked=1)


@pytest.mark.parametrize("certificate", ["none", "local"])
@pytest.mark.parametrize(
    "slip", [{"failure": 1.0}, {"failure": float("nan")}, {"failure": "x"}, {"levels": 3}, {"attacked": -1}]
)
def test_options_of_certificates_are_looked_at_even_without_one(certificate: str, slip: dict[str, Any]) -> None:
    model, net, filt = parts()
    with pytest.raises(gr.InvalidInput, match=f"^{next(iter(slip))}: got "):
        gr.simulate(model, net, filt, steps=2, certificate=certificate, **({"attacked": 1} | slip))


def test_a_run_with_levels_is_repeated_with_them() -> None:
    model, net, filt = parts()
    asked: dict[str, Any] = {"steps": 5, "noise": "normal", "certificate": "local", "attacked": 1}
    run = gr.simulate(model, net, filt, levels=(8.0, 9.0), **asked)
    assert run.made["levels"] == [8.0, 9.0] and gr.again(run) == run
    assert not np.array_equal(run.bound, gr.simulate(model, net, filt, **asked).bound, equal_nan=True)


def test_check_says_what_to_expect() -> None:
    plain = gr.check(*parts())
    found = gr.check(*parts(), certificate="flooded", attacked=1)
    assert len(found.quantities) == len(plain.quantities) + 2 + parts()[0].states
    assert all(0 < found[f"certify_{name}"] < np.inf for name in parts()[0].state_names)  # theorem B2
    assert 0 < found["certificate_expected"] < 0.2 and found["certificate_agents"] == 1
    law = next(q["meaning"] for q in found.quantities if q["name"] == "certificate_expected")
    chance = 1e-6 * 1000 * parts()[0].agents
    assert "1e-06 per agent and sample" in law and law.endswith(
        f"over 1000 samples is wrong has a chance of at most {chance:.2g}"
    )
    wider = gr.check(*parts(), certificate="flooded", attacked=2)
    assert wider["certificate_expected"] > found["certificate_expected"]
    assert (
        gr.prepare(*parts(), certificate="flooded", attacked=1).check()["certificate_expected"]
        == (found["certificate_expected"])
    )


def test_a_scenario_with_a_certificate_writes_its_kind(wind: Path, tmp_path: Path) -> None:
    text = (wind / "hijacked.toml").read_text()
    short = text.replace('from = "1971-01-01"', 'from = "1971-12-20"\nto = "1972-01-20"')
    for name in ("irish_wind.csv", "stations.csv"):
        (tmp_path / name).write_bytes((wind / name).read_bytes())
    (tmp_path / "short.toml").write_text(short)
    assert main(["run", str(tmp_path / "short.toml"), "-o", str(tmp_path / "out"), "--no-conditions"]) == 0
    rows = list(csv.DictReader((tmp_path / "out" / "estimates.csv").read_text().splitlines()))
    words = {row["bound_kind"] for row in rows if row["time"] != "0"}
    assert words <= {"witness", "relayed", "published"} and "witness" in words
    page = (tmp_path / "out" / "report.html").read_text()
    assert "except with probability 1e-06 per agent and sample" in page and "certificate_expected" in page
    (tmp_path / "bad.toml").write_text(short.replace('spread = "flooded"', 'spread = "everywhere"'))
    assert main(["check", str(tmp_path / "bad.toml")]) == 2


def test_fit_stores_levels_that_clean_records_keep(wind: Path, tmp_path: Path) -> None:
    model = tmp_path / "model.json"
    options = ["--factors", "1", "--root", "--scale", "0.514444", "--to", "1970-12-31", "--attacked", "3"]
    assert main(["fit", str(wind / "irish_wind.csv"), *options, "-o", str(model)]) == 0
    kept = json.loads(model.read_text())
    levels = kept["levels"]
    assert (levels["attacked"], levels["failure"]) == (3, 1e-3)
    gaussian = gr.certificate.gaussian_levels(1e-3, 12, 1)
    assert levels["z1"] > gaussian[0] and levels["z2"] > gaussian[1]  # tails of real records
    assert np.allclose(kept["inflated"]["measurement_bound"], 1.1 * np.array(kept["measurement_bound"]))
    assert kept["inflated"]["process_bound"] == pytest.approx(1.1 * kept["process_bound"])


def test_levels_of_clean_records_take_the_place_of_the_gaussian_ones() -> None:
    told = {"certificate": "flooded", "failure": 1e-3, "attacked": 1}
    runs = {"steps": 20, "seed": 1, "conditions": False}
    plain = gr.simulate(*parts(), **told, **runs)
    wide = gr.simulate(*parts(), **told, **runs, levels=(9.0, 9.0))
    assert (wide.bound[:, 1:] > plain.bound[:, 1:]).all()
    design = gr.prepare(*parts(), **told, levels=(9.0, 9.0))
    assert design.certificate == told | {"levels": (9.0, 9.0)}
    assert np.array_equal(design.simulate(**runs).bound, wide.bound)
    assert "clean records" in str(gr.check(*parts(), **told, levels=(9.0, 9.0)))


@pytest.mark.parametrize("levels", [(1.0,), (0.0, 1.0), (4.0, float("nan")), "calibrated", 5.0])
def test_levels_that_are_none_are_refused(levels: object) -> None:
    with pytest.raises(gr.InvalidInput, match="levels"):
        gr.prepare(*parts(), certificate="flooded", failure=1e-3, attacked=1, levels=levels)
    with pytest.raises(gr.InvalidInput, match="levels"):
        gr.prepare(*parts(), certificate="flooded", failure=0.0, attacked=1, levels=(4.0, 4.0))


def test_a_scenario_takes_the_levels_of_its_fit() -> None:
    wind = ROOT / "examples" / "wind" / "hijacked.toml"
    scenario = read_scenario(wind, set={"certificate.failure": 1e-3, "certificate.levels": "calibrated"})
    assert scenario.fitted is not None
    assert scenario.certificate["levels"] == scenario.fitted.levels(3, 1e-3)
    given = read_scenario(wind, set={"certificate.levels": [6.0, 5.5]})
    assert given.certificate["levels"] == (6.0, 5.5)
    for wrong, why in (({"failure": 1e-6, "levels": "calibrated"}, "failure >="), ({"levels": "all"}, "levels")):
        with pytest.raises(gr.InvalidInput, match=why):
            read_scenario(wind, set={f"certificate.{key}": value for key, value in wrong.items()})


def test_measurements_that_contradict_the_certificate_are_told() -> None:
    model = gr.Model([[0.95]], [[[1.0]]] * 3, process_bound=0.1, measurement_bound=0.1)
    net, filter = gr.Network.complete(3), gr.filters.ScalarGain(rounds=2)
    asked = {"certificate": "flooded", "failure": 0.0, "attacked": 1}
    for y, contradicted in (([0.0, 5.0, 10.0], True), ([0.0, 0.1, 10.0], False)):
        run = gr.replay(model, net, filter, measurements=np.tile(y, (5, 1)), **asked)
        assert any("contradict what the certificate assumes" in w for w in run.warnings) == contradicted
        assert (run.bound_kind == gr.BoundKind.REFUTED).any() == contradicted


def test_understated_noise_bounds_raise_a_doubt_about_the_certificate() -> None:
    told = 0
    for seed in range(5):
        true = gr.Model([[0.95]], [[[1.0]]] * 6, process_bound=0.1, measurement_bound=0.5)
        small = gr.Model([[0.95]], [[[1.0]]] * 6, process_bound=0.1, measurement_bound=0.375)
        net, filter = gr.Network.complete(6), gr.filters.ScalarGain(rounds=2)
        y = gr.simulate(true, net, filter, steps=300, noise="uniform", seed=seed, keep=["measurements"]).measurements
        asked = {"measurements": y, "certificate": "flooded", "failure": 0.0, "attacked": 1}
        told += any("contradict" in w for w in gr.replay(small, net, filter, **asked).warnings)
        assert not any("contradict" in w for w in gr.replay(true, net, filter, **asked).warnings)
    assert told == 5


def test_a_source_behind_several_agents_voids_bounds_that_count_agents() -> None:
    sources = ["gps", "gps", *"cdefgh"]
    model = gr.Model([[1.0]], [[1.0]] * 8, process_bound=0.01, measurement_bound=0.1, sources=sources)
    filter = gr.filters.Saturation(threshold=0.7, rounds=12, attacked=1, initial_error=2.0)
    lie = gr.attacks.Bias(agents=[0, 1], value=5.0)
    options = {"steps": 200, "attack": lie, "noise": "extreme", "seed": 1}
    promise = {"certificate": "flooded", "failure": 0.0, "attacked": 1}
    run = gr.simulate(model, gr.Network.complete(8), filter, **options, **promise)
    assert run.error is not None and run.bound is not None and run.bound_kind is not None
    assert (run.error <= run.bound)[:, 1:].all() and not (run.bound_kind == gr.BoundKind.PUBLISHED).any()
    assert any("stand behind several agents (gps)" in line for line in run.warnings)
    assert not any("pairs of sensors" in line or "contradict" in line for line in run.warnings)
