"""Where tasks run: in this process, in worker processes, or on a Dask cluster that somebody has started."""

import multiprocessing
import queue
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from typing import Any

from garrison.sweeps.work import Task, work
from garrison.words import refusal

#: how often a task is tried again whose worker died
RETRIES = 2
#: tasks, and what came of each: None, or why it is lost
Outcome = tuple[Task, str | None]


def outcomes(tasks: Sequence[Task], workers: int, client: Any) -> Iterator[Outcome]:
    """Run the tasks, in any order; one outcome each. Ctrl-C ends the workers that were started here."""
    if not tasks:
        return iter(())
    if client is not None:
        return _on_cluster(tasks, client)
    return _here(tasks) if workers == 1 else _in_processes(tasks, workers)


def _here(tasks: Sequence[Task]) -> Iterator[Outcome]:
    for task in tasks:
        work(task)
        yield task, None


def _in_processes(tasks: Sequence[Task], workers: int) -> Iterator[Outcome]:
    """A worker that dies takes its pool with it; who was running then is tried again alone, RETRIES times."""
    left, suspects = list(tasks), list[Task]()
    while left:
        with _pool(min(workers, len(left))) as pool:
            running: set[Task] = set()
            for task, error in _finished(left, pool.submit, workers, running):
                if isinstance(error, BrokenProcessPool):
                    suspects += sorted(running | {task}, key=lambda t: t.name)
                    left = [t for t in left if t not in suspects]
                    break
                left = [t for t in left if t is not task]
                yield task, None if error is None else _words(error)
    for task in suspects:
        yield task, _alone(task)


def _alone(task: Task) -> str | None:
    """None, or why the task is lost."""
    for _ in range(RETRIES):
        with _pool(1) as pool:
            error = pool.submit(work, task).exception()
        if not isinstance(error, BrokenProcessPool):
            return None if error is None else _words(error)
    return f"its worker died {1 + RETRIES} times"


@contextmanager
def _pool(workers: int) -> Iterator[ProcessPoolExecutor]:
    """Fresh processes; an error here, or Ctrl-C, ends them at once."""
    before = set(multiprocessing.active_children())
    with ProcessPoolExecutor(workers, mp_context=multiprocessing.get_context("spawn")) as pool:
        try:
            yield pool
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            for child in set(multiprocessing.active_children()) - before:
                child.terminate()
            raise


def _on_cluster(tasks: Sequence[Task], client: Any) -> Iterator[Outcome]:
    futures: list[Any] = []

    def submit(function: Callable[[Task], float], task: Task) -> Any:
        key = f"garrison-sweep-{task.name}"
        futures.append(client.submit(function, task, key=key, retries=RETRIES, pure=True))
        return futures[-1]

    try:
        for task, error in _finished(tasks, submit, len(tasks), set()):
            yield task, None if error is None else _words(error)
    except BaseException:
        for future in futures:
            future.cancel()
        raise


def _finished(
    tasks: Sequence[Task], submit: Callable[[Callable[[Task], float], Task], Any], most: int, running: set[Task]
) -> Iterator[tuple[Task, BaseException | None]]:
    """Tasks as they end, with their error; at most `most` at a time, which are in `running`."""
    ended: queue.SimpleQueue[tuple[Task, Any]] = queue.SimpleQueue()
    waiting = list(reversed(tasks))
    while waiting or running:
        while waiting and len(running) < most:
            task = waiting.pop()
            running.add(task)
            try:
                submit(work, task).add_done_callback(lambda future, task=task: ended.put((task, future)))
            except BrokenProcessPool as error:
                yield task, error
        task, future = ended.get()
        running.discard(task)
        yield task, future.exception()


def _words(error: BaseException) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())


def cluster(scheduler: str | None, scheduler_file: str | None) -> Any:
    """A client of a running Dask scheduler; None where no address is given."""
    if scheduler is None and scheduler_file is None:
        return None
    try:
        from distributed import Client
    except ImportError:
        raise refusal("--scheduler", "no dask.distributed", 'it installed: pip install "garrison[sweep]"') from None
    return Client(scheduler) if scheduler is not None else Client(scheduler_file=scheduler_file)
