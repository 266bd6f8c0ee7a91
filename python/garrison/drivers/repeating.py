"""Run once more what a run keeps."""

from garrison.drivers.replaying import replay
from garrison.drivers.simulating import simulate
from garrison.recipe import recipe
from garrison.record import Run
from garrison.words import hinted, refusal


@hinted
def again(run: Run) -> Run:
    """Run once more what a run keeps, also a loaded one.

    Parameters
    ----------
    run : Run
        Of simulate or replay. A replay needs the measurements that were kept.

    Returns
    -------
    Run
        Equal to it, bit for bit.

    Raises
    ------
    InvalidInput
        The measurements are missing, or an attack or the plant was written in Python.
    """
    if not isinstance(run, Run):
        raise refusal("again", f"a {type(run).__name__}", "a garrison.Run")
    driver, objects, given = recipe(run)
    return simulate(*objects, **given) if driver == "simulate" else replay(*objects, **given)
