"""Executes runs on a Dask cluster, which exists already or is started from a cluster profile.

Workers need the same version of rmfs as this machine, and your input files under the same paths (on
a shared file system); every worker checks the hashes of the inputs. Start workers with one thread
each (`dask worker ADDRESS --nworkers N --nthreads 1`), so that each executes one run at a time.
"""

from __future__ import annotations

import argparse
import logging
import queue
import sys
from concurrent.futures import CancelledError
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import pydantic

from rmfs.config import Model, read_toml, validate
from rmfs.errors import InputError
from rmfs.experiments.extras import optional
from rmfs.experiments.running.job import Job, Outcome

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

EXTRA = "dask"
CONNECT_S = 30.0

CLUSTERS = {
    "slurm": "SLURMCluster",
    "pbs": "PBSCluster",
    "sge": "SGECluster",
    "lsf": "LSFCluster",
    "oar": "OARCluster",
    "htcondor": "HTCondorCluster",
}
"""Classes of dask-jobqueue."""


class Profile(Model):
    """A cluster profile (format `rmfs-cluster/1`), with settings for dask-jobqueue.

    `cluster = "local"` starts workers on this machine, for testing.
    """

    format: Literal["rmfs-cluster/1"]
    cluster: Literal["slurm", "pbs", "sge", "lsf", "oar", "htcondor", "local"]
    workers: int = pydantic.Field(ge=1, description="processes in all, one run each at a time")
    options: dict[str, Any] = pydantic.Field(
        {}, description="further arguments of the cluster class, such as queue, memory, walltime"
    )


class DaskWorkers:
    """Executes jobs on the workers of a Dask cluster.

    Parameters
    ----------
    address
        Address of a scheduler (`tcp://HOST:PORT`), or a profile (.toml file).
    work
        Function that executes a job. Default: `running.execute.execute`.

    Raises
    ------
    InputError
        If Dask is not installed, the scheduler does not answer, or the profile is invalid.
    """

    def __init__(self, address: str, work: Callable[[Job], Outcome] | None = None) -> None:
        self._distributed = optional("distributed", EXTRA, "--dask")
        # it logs tracebacks of its own threads; what matters is reported here in one line
        for name in ("distributed", "distributed.client"):
            logging.getLogger(name).setLevel(logging.CRITICAL)
        self._work = work
        self._address = address
        self._cluster: Any = None
        target: Any = address
        if Path(address).suffix == ".toml":
            target = self._cluster = started(read_profile(Path(address)), address)
        try:
            self.client = self._distributed.Client(target, timeout=CONNECT_S, set_as_default=False)
        except (OSError, ValueError) as error:
            raise InputError(f"--dask {address}: no scheduler answers ({error})") from None
        self._done: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._jobs: dict[Any, Job] = {}

    @property
    def slots(self) -> int:
        """Maximum number of unfinished jobs: two per worker thread, so that no thread is idle."""
        with self._scheduler_there():
            workers = self.client.scheduler_info(n_workers=-1)["workers"].values()
        threads = [int(worker["nthreads"]) for worker in workers]
        return 2 * max(1, sum(threads))

    def submit(self, job: Job) -> None:
        """Submit a job to a worker; if the worker dies, Dask submits the job to another."""
        with self._scheduler_there():
            future = self.client.submit(_work_of(self._work), job, pure=False)
        self._jobs[future] = job
        future.add_done_callback(self._done.put)

    def wait(self, timeout_s: float) -> list[tuple[Job, Outcome]]:
        """Return ended jobs with their outcomes; if there are none yet, wait up to `timeout_s`.

        Raises
        ------
        InputError
            If the scheduler no longer answers.
        """
        ended: list[tuple[Job, Outcome]] = []
        try:
            ended.append(self._result(self._done.get(timeout=timeout_s)))
            while True:
                ended.append(self._result(self._done.get_nowait()))
        except queue.Empty:
            return ended

    def close(self) -> None:
        """Cancel all unfinished jobs and disconnect; stop the cluster if this object started it."""
        # a scheduler that is gone has nothing to cancel
        with suppress(OSError, RuntimeError, CancelledError):
            self.client.cancel(list(self._jobs), force=True)
            self.client.close()
        self._jobs.clear()
        if self._cluster is not None:
            self._cluster.close()

    def _result(self, future: Any) -> tuple[Job, Outcome]:
        job = self._jobs.pop(future)
        with self._scheduler_there():
            error = future.exception()
            if isinstance(error, CancelledError):
                raise error
            if error is None:
                return job, future.result()
        # what goes wrong in a run is part of its outcome: this is the cluster's own trouble
        return job, Outcome(error=f"{type(error).__name__}: {error}".splitlines()[0], died=True)

    @contextmanager
    def _scheduler_there(self) -> Iterator[None]:
        """Report a lost scheduler by an error of one line, whatever error Dask raises."""
        try:
            yield
        except (OSError, RuntimeError, CancelledError) as error:
            raise InputError(
                f"--dask {self._address}: the connection to the scheduler is lost "
                f"({type(error).__name__}); finished runs are stored: repeat the command to "
                "continue"
            ) from None


def read_profile(path: Path) -> Profile:
    """Read a cluster profile.

    Raises
    ------
    InputError
        If the profile is missing or invalid.
    """
    return validate(Profile, read_toml(path), str(path))


def job_script(path: Path) -> str:
    """Return the script that would be submitted to the batch system to start workers.

    Raises
    ------
    InputError
        If the profile is invalid or names no batch system, or dask-jobqueue is not installed.
    """
    profile = read_profile(path)
    if profile.cluster == "local":
        raise InputError(f'{path}: cluster = "local" has no job script, as it uses no batch system')
    cluster = started(profile.model_copy(update={"workers": 0}), str(path))
    try:
        return str(cluster.job_script())
    finally:
        cluster.close()


def started(profile: Profile, source: str) -> Any:
    """Start a cluster from a profile, with workers on this machine or as batch jobs; return it.

    Parameters
    ----------
    source
        Name of the profile, for error messages.

    Raises
    ------
    InputError
        If the options of the profile are invalid.
    """
    options = dict(profile.options)
    try:
        if profile.cluster == "local":
            distributed = optional("distributed", EXTRA, "--dask")
            return distributed.LocalCluster(
                n_workers=profile.workers,
                threads_per_worker=1,
                **({"dashboard_address": None} | options),
            )
        jobqueue = optional("dask_jobqueue", EXTRA, f"cluster {profile.cluster}")
        # a worker process has one thread: as many processes as cores in each job of the queue
        options.setdefault("cores", 1)
        options.setdefault("processes", options["cores"])
        cluster = getattr(jobqueue, CLUSTERS[profile.cluster])(**options)
        cluster.scale(n=profile.workers)
    except (TypeError, ValueError) as error:
        raise InputError(f"{source}: options: {str(error).splitlines()[0]}") from None
    return cluster


def _work_of(work: Callable[[Job], Outcome] | None) -> Callable[[Job], Outcome]:
    if work is not None:
        return work
    # imported by the worker
    from rmfs.experiments.running.execute import execute

    return execute


def main(arguments: list[str] | None = None) -> int:
    """Print the job script of a profile: `python -m rmfs.experiments.running.cluster PROFILE`."""
    parser = argparse.ArgumentParser(prog="python -m rmfs.experiments.running.cluster")
    parser.add_argument("profile", type=Path, help="a cluster profile (.toml)")
    given = parser.parse_args(arguments)
    try:
        print(job_script(given.profile))
    except InputError as error:
        print(f"cluster: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
