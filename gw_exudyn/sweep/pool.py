"""Dask workers that run points: on this machine, or of a cluster that exists; one code path for both."""

from __future__ import annotations

import logging
import queue
import secrets
import signal
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from typing import Any

from gw_exudyn.errors import SolverError, UsageError
from gw_exudyn.sweep.runner import Outcome, Task

CONNECT_LIMIT = 30.0
"""Seconds within which a scheduler has to answer."""

_WINDOW = 4
"""Points under way or waiting for each thread of a worker: enough that none waits for the next, few enough that ten
thousand points need no more memory than ten."""

_SETTINGS = {
    "distributed.scheduler.allowed-failures": 3,
    # What dask watches of itself costs processor time that points need.
    "distributed.worker.profile.enabled": False,
    "distributed.admin.system-monitor.interval": "5s",
    "distributed.admin.system-monitor.gil.enabled": False,
    "distributed.admin.tick.interval": "1s",
    "distributed.admin.tick.limit": "1h",
    "distributed.scheduler.work-stealing-interval": "1s",
}

_LOOK = 0.2  # seconds between two looks at whether to stop
_COUNT_WORKERS = 25  # looks between two counts of the workers


class Pool:
    """Workers of one sweep. Made by `pool`."""

    def __init__(self, client: Any, plugin: str) -> None:
        self._client, self._plugin = client, plugin
        self._done: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self.threads = 0

    def run(
        self,
        tasks: Iterator[Task],
        keep: Callable[[Task, Outcome], None],
        should_stop: Callable[[], bool] = lambda: False,
        look: Callable[[], None] = lambda: None,
    ) -> bool:
        """Run tasks, in their order as far as there are workers; False when it was stopped on the way.

        keep : called with each task and its outcome, in the order in which they end. should_stop, look : asked and
        called a few times a second.

        Raises SolverError where workers cannot run anything, and what `keep` raises.
        """
        pending: dict[Any, Task] = {}
        looks = 0
        try:
            while True:
                if looks % _COUNT_WORKERS == 0:
                    self.threads = sum(self._client.nthreads().values())
                self._fill(pending, tasks)
                if not pending:
                    return True
                for future, outcome in self._ended():
                    keep(pending.pop(future), outcome)
                    future.release()
                looks += 1
                look()
                if should_stop():
                    return False
        finally:
            with suppress(Exception):
                self._client.cancel(list(pending), force=True)

    def _fill(self, pending: dict[Any, Task], tasks: Iterator[Task]) -> None:
        from gw_exudyn.sweep.worker import run_point

        while len(pending) < _WINDOW * max(self.threads, 1):
            task = next(tasks, None)
            if task is None:
                return
            key = f"gw-exudyn-{task.id}-{secrets.token_hex(4)}"
            future = self._client.submit(run_point, task, self._plugin, key=key, pure=False)
            pending[future] = task
            future.add_done_callback(self._done.put)

    def _ended(self) -> list[tuple[Any, Outcome]]:
        """Futures that have ended since, with their outcomes; waits a moment where there is none."""
        futures = []
        with suppress(queue.Empty):
            futures.append(self._done.get(timeout=_LOOK))
            while True:
                futures.append(self._done.get_nowait())
        if not futures:
            return []
        try:
            return list(zip(futures, self._client.gather(futures), strict=True))
        except Exception:  # one of them failed; which one is found out one by one
            return [(future, _outcome(future)) for future in futures]


def _outcome(future: Any) -> Outcome:
    from distributed import KilledWorker

    try:
        outcome: Outcome = future.result()
    except KilledWorker as error:
        return Outcome(
            "crashed", f"The worker that ran the point was lost, {error.allowed_failures + 1} times in a row."
        )
    except SolverError:
        raise
    except Exception as error:  # cancelled: the scheduler is gone; else the worker cannot run our code at all
        raise SolverError(
            f"the workers cannot go on ({type(error).__name__}: {error}); what is done is kept"
        ) from error
    return outcome


@contextmanager
def pool(jobs: int, scheduler: str | None, runner: str, timeout: float | None) -> Iterator[Pool]:
    """Workers, for as long as the block lasts; their children end with it.

    jobs : worker processes on this machine, one thread each. scheduler : address of a dask scheduler whose workers
    are to be used instead. runner, timeout : as `PointProcess` takes them.

    Raises UsageError where no scheduler answers, SolverError where the workers cannot load gw_exudyn.
    """
    import dask
    from distributed import Client

    from gw_exudyn.sweep.worker import PointWorker

    make_client: Any = Client  # it comes without types
    logging.getLogger("distributed").setLevel(logging.CRITICAL)  # what goes wrong is told by our own words
    name = f"gw-exudyn-{secrets.token_hex(8)}"
    with ExitStack() as stack:
        stack.enter_context(dask.config.set(_SETTINGS))
        address = scheduler if scheduler is not None else stack.enter_context(_on_this_machine(jobs))
        try:
            client = stack.enter_context(make_client(address, timeout=CONNECT_LIMIT, set_as_default=False))
        except (OSError, TimeoutError, ValueError) as error:
            raise UsageError(f"--scheduler {scheduler}: no dask scheduler answers there ({error})") from error
        try:
            client.register_plugin(PointWorker(name, runner, timeout), name=name)
        except Exception as error:
            raise SolverError(f"the workers cannot load gw_exudyn ({type(error).__name__}: {error})") from error
        try:
            yield Pool(client, name)
        finally:
            with suppress(Exception):
                client.unregister_worker_plugin(name)


@contextmanager
def _on_this_machine(jobs: int) -> Iterator[str]:
    """The address of a scheduler in this process, with worker processes that end with it."""
    from distributed import LocalCluster

    make_cluster: Any = LocalCluster  # it comes without types

    with _interrupts_for_us_alone():
        cluster = make_cluster(
            n_workers=jobs,
            threads_per_worker=1,
            processes=True,
            host="127.0.0.1",
            dashboard_address=None,
            # Without a dashboard there is still a port for it; any free one, of this machine alone.
            scheduler_kwargs={"dashboard": False, "dashboard_address": "127.0.0.1:0"},
            memory_limit=0,
            silence_logs=logging.CRITICAL,
        )
    try:
        yield cluster.scheduler_address
    finally:
        cluster.close()


@contextmanager
def _interrupts_for_us_alone() -> Iterator[None]:
    """Threads and processes started within do not hear Ctrl-C; the one who started them does."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    from multiprocessing import resource_tracker

    # It would be started within, and unblocks the signal for the thread that starts it.
    resource_tracker.ensure_running()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
