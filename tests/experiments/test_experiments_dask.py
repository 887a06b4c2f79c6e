"""A Dask cluster in place of this machine: the same table, even if a worker is killed."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import threading
import time

import pytest

from rmfs import experiments
from rmfs.errors import InputError
from rmfs.experiments.results import reproducible_table
from rmfs.experiments.running.cluster import DaskWorkers, job_script
from rmfs.experiments.running.cluster import main as cluster_main

distributed = pytest.importorskip("distributed")

BASE = {
    "layout": "basic",
    "scenario": "basic",
    "controllers": "default",
    "scenario.duration_s": 1800,
}


def table(folder) -> str:
    return reproducible_table(experiments.load(folder)).to_csv(index=False)


@pytest.mark.slow
def test_a_cluster_of_four_workers_gives_the_same_table(design, tmp_path):
    """Issue 6, "must show" 2; one worker is killed as soon as a third of the runs is there."""
    plan = experiments.plan(design(base=BASE, seeds=[1, 2, 3, 4, 5, 6]))
    out = tmp_path / "out"
    killed = []
    with distributed.LocalCluster(
        n_workers=4, threads_per_worker=1, dashboard_address=None
    ) as cluster:

        def kill() -> None:
            while len(list((out / "runs").glob("[!.]*.parquet"))) < 8:
                time.sleep(0.01)
            nanny = next(iter(cluster.workers.values()))
            killed.append(nanny.pid)
            os.kill(nanny.pid, signal.SIGKILL)

        killer = threading.Thread(target=kill, daemon=True)
        killer.start()
        done = experiments.run(plan, out, dask=cluster.scheduler_address)
        killer.join(10)
    assert killed
    assert (done.ran, done.finished, done.failed) == (24, 24, [])
    experiments.run(plan, tmp_path / "local", processes=2)
    assert table(out) == table(tmp_path / "local")


@pytest.fixture
def own_cluster():
    """Return a scheduler in a process of its own, its address, and a worker that it has."""
    with socket.socket() as asked:
        asked.bind(("127.0.0.1", 0))
        port = str(asked.getsockname()[1])
    address = f"tcp://127.0.0.1:{port}"
    commands = (
        ["dask_scheduler", "--host", "127.0.0.1", "--port", port, "--no-dashboard"],
        ["dask_worker", address, "--nthreads", "1", "--no-nanny", "--no-dashboard"],
    )
    started = [
        subprocess.Popen(
            [sys.executable, "-m", f"distributed.cli.{name}", *options],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        for name, *options in commands
    ]
    yield started[0], address
    for one in started:
        one.kill()
        one.wait()


@pytest.mark.slow
def test_a_scheduler_that_is_killed_loses_nothing(own_cluster, tmp_path):
    scheduler, address = own_cluster
    design = tmp_path / "design.toml"
    design.write_text(
        'format = "rmfs-design/1"\nname = "tiny"\nseeds = [1, 2, 3, 4]\n[base]\n'
        'layout = "basic"\nscenario = "basic"\ncontrollers = "default"\n'
        '"scenario.duration_s" = 1800\n[factors]\n'
        '"controllers.psa" = ["nearest", "random"]\n'
    )
    out = tmp_path / "out"
    rmfs = [sys.executable, "-m", "rmfs", "experiment", "run", str(design), "--out"]
    run = subprocess.Popen([*rmfs, out, "--dask", address], stderr=subprocess.PIPE, text=True)
    while not list((out / "runs").glob("[!.]*.parquet")):
        assert run.poll() is None
        time.sleep(0.02)
    scheduler.kill()
    _, words = run.communicate(timeout=120)
    assert run.returncode == 2, words
    assert "the scheduler is gone" in words.splitlines()[-1]
    assert "Traceback" not in words
    assert 0 < len(list((out / "runs").glob("[!.]*.parquet"))) < 8
    for folder in (out, tmp_path / "local"):
        subprocess.run([*rmfs, folder, "--jobs", "1"], check=True, capture_output=True)
    assert table(out) == table(tmp_path / "local")


@pytest.mark.slow
def test_a_profile_starts_a_cluster(design, tmp_path):
    profile = tmp_path / "cluster.toml"
    profile.write_text('format = "rmfs-cluster/1"\ncluster = "local"\nworkers = 2\n')
    plan = experiments.plan(design(base=BASE, factors=None, seeds=[1, 2]))
    done = experiments.run(plan, tmp_path / "out", dask=str(profile))
    assert done.finished == 2


@pytest.mark.slow
def test_a_failing_run_does_not_stop_the_cluster(design, tmp_path, monkeypatch):
    import stand_in

    profile = tmp_path / "cluster.toml"
    profile.write_text('format = "rmfs-cluster/1"\ncluster = "local"\nworkers = 2\n')
    plan = experiments.plan(design())
    engine = DaskWorkers(str(profile), work=stand_in.work_that_fails_for_random)
    from rmfs.experiments.running.driver import drive
    from rmfs.experiments.store import Store

    done = drive(plan, Store(tmp_path / "out"), engine)
    assert (done.finished, len(done.failed)) == (10, 2)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ('cluster = "slurn"\nworkers = 2', "cluster"),
        ('cluster = "local"\nworkers = 0', "workers"),
        ('cluster = "local"\nworkers = 1\nqueue = "x"', "unknown key queue"),
    ],
)
def test_a_wrong_profile_is_refused(tmp_path, text, told):
    profile = tmp_path / "cluster.toml"
    profile.write_text(f'format = "rmfs-cluster/1"\n{text}\n')
    with pytest.raises(InputError, match=told):
        DaskWorkers(str(profile))


def test_a_batch_system_is_told_to_start_single_threaded_workers(monkeypatch, tmp_path):
    jobqueue = pytest.importorskip("dask_jobqueue")
    from rmfs.experiments.running.cluster import Profile, started

    made = []

    class Cluster:
        def __init__(self, **options):
            made.append(options)

        def scale(self, n):
            made.append(n)

    monkeypatch.setattr(jobqueue, "SLURMCluster", Cluster)
    profile = Profile(
        format="rmfs-cluster/1",
        cluster="slurm",
        workers=40,
        options={"queue": "short", "memory": "4GB", "cores": 8},
    )
    started(profile, "cluster.toml")
    assert made == [{"queue": "short", "memory": "4GB", "cores": 8, "processes": 8}, 40]


def test_a_scheduler_that_does_not_answer_is_told(monkeypatch):
    monkeypatch.setattr("rmfs.experiments.running.cluster.CONNECT_S", 0.2)
    with pytest.raises(InputError, match="no scheduler answers"):
        DaskWorkers("tcp://127.0.0.1:9")


SCRIPTS = {
    "slurm": ("#SBATCH -p short", "#SBATCH --cpus-per-task=8", "#SBATCH -t 02:00:00"),
    "pbs": ("#PBS -q short", "#PBS -l select=1:ncpus=8:mem=15GB", "#PBS -l walltime=02:00:00"),
    "sge": ("#$ -q short", "#$ -l h_rt=02:00:00"),
    "lsf": ("#BSUB -q short", "#BSUB -n 8", "#BSUB -W 02:00"),
    "oar": ("#OAR -q short", "walltime=02:00:00"),
    "htcondor": ("RequestCpus = MY.DaskWorkerCores", "MY.DaskWorkerCores = 8"),
}
"""What must be in the job script of each batch system, by its own manual."""


@pytest.mark.parametrize("cluster", SCRIPTS)
def test_the_job_script_of_each_batch_system(tmp_path, cluster, capsys):
    """Resources are asked for, and eight single-threaded workers begun in each job."""
    pytest.importorskip("dask_jobqueue")
    options = ["cores = 8", 'memory = "16GB"']
    if cluster == "htcondor":
        options += ['disk = "1GB"']
    else:
        options += [
            'queue = "short"',
            f'walltime = "{"02:00" if cluster == "lsf" else "02:00:00"}"',
        ]
    profile = tmp_path / "cluster.toml"
    head = f'format = "rmfs-cluster/1"\ncluster = "{cluster}"\nworkers = 40\n[options]\n'
    profile.write_text(head + "\n".join(options))
    assert cluster_main([str(profile)]) == 0
    script = capsys.readouterr().out
    for line in (*SCRIPTS[cluster], "--nthreads 1", "--nworkers 8"):
        assert line in script, script


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ('cluster = "local"\nworkers = 2', "has no job script"),
        ('cluster = "slurm"\nworkers = 2\n[options]\nquue = "x"\nmemory = "1GB"', "options: "),
        ('cluster = "slurm"\nworkers = 2', "options: "),
    ],
)
def test_a_profile_without_a_job_script_is_refused(tmp_path, text, told, capsys):
    pytest.importorskip("dask_jobqueue")
    profile = tmp_path / "cluster.toml"
    profile.write_text(f'format = "rmfs-cluster/1"\n{text}\n')
    with pytest.raises(InputError, match=told):
        job_script(profile)
    assert cluster_main([str(profile)]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 1
