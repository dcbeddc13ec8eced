"""A dask worker's side: a plugin that holds the worker's child processes, and the function that runs a point."""

from __future__ import annotations

import threading
from typing import Any

from distributed import WorkerPlugin, get_worker

from gw_exudyn.sweep.point_process import PointProcess
from gw_exudyn.sweep.runner import Outcome, Task


class PointWorker(WorkerPlugin):
    """Gives every thread of a worker its child process, and ends them all with the sweep.

    name : of this sweep's plugin. runner, timeout : as `PointProcess` takes them.
    """

    def __init__(self, name: str, runner: str, timeout: float | None) -> None:
        self.name, self._runner, self._timeout = name, runner, timeout
        self._processes: dict[int, PointProcess] = {}

    def process(self) -> PointProcess:
        """The child process of this thread."""
        mine = threading.get_ident()
        if mine not in self._processes:
            self._processes[mine] = PointProcess(self._runner, self._timeout)
        return self._processes[mine]

    def teardown(self, worker: Any) -> None:
        """End the children, those at work as well."""
        for process in list(self._processes.values()):
            process.close()


def run_point(task: Task, plugin: str) -> Outcome:
    """Run a point on this worker. Raises SolverError where its child cannot be started."""
    found = get_worker().plugins[plugin]
    if not isinstance(found, PointWorker):
        raise TypeError(f"{plugin} is no plugin of a sweep")
    return found.process().run(task)
