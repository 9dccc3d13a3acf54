#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds scripts/slurm to a real Slurm, started here: shards (killed, warned, cancelled), the merged image; separations.

Needs root and Debian's packages slurm-wlm and munge (`scripts/test.sh -L slurm` installs them); exits with 77 otherwise.
"""

import argparse
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SKIPPED = 77
PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "scontrol", "squeue")
ROOT = Path(__file__).resolve().parent.parent
SPP, SHARDS, KILLED, WARNED = 1000, 4, 1, 2
TIMEOUT_S = 420


def skip(reason: str) -> None:
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def free_port() -> int:
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Cluster:
    """One node, this machine, with daemons, key and ports of its own."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.daemons: list[subprocess.Popen] = []
        host = socket.gethostname().split(".")[0]
        key = folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        conf = folder / "slurm.conf"
        # A requeued job waits until its credential has expired: 120 s unless told.
        conf.write_text(f"""ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={free_port()}
SlurmdPort={free_port()}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
JobRequeue=1
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
""")
        for name in ("state", "spool"):
            (folder / name).mkdir()
        self.environment = {**os.environ, "SLURM_CONF": str(conf)}

    def __enter__(self) -> "Cluster":
        f = self.folder
        self.start("munged", "--foreground", "--force", f"--socket={f}/munge.socket", f"--key-file={f}/munge.key",
                   f"--pid-file={f}/munged.pid", f"--log-file={f}/munged.log", f"--seed-file={f}/munged.seed")
        self.wait_for(lambda: (f / "munge.socket").exists(), "munge's socket")
        self.start("slurmctld", "-D", "-i")
        self.start("slurmd", "-D")
        self.wait_for(lambda: "idle" in self.run("sinfo", "-h", "-o", "%t", check=False), "an idle node")
        return self

    def __exit__(self, *_: object) -> None:
        for daemon in reversed(self.daemons):
            daemon.terminate()
        for daemon in self.daemons:
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()

    def start(self, *command: str) -> None:
        log = open(self.folder / f"{command[0]}.out", "wb")  # noqa: SIM115: as long as the daemon
        self.daemons.append(subprocess.Popen(command, env=self.environment, stdout=log, stderr=log,
                                             stdin=subprocess.DEVNULL))

    def run(self, *command: str, check: bool = True) -> str:
        done = subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=TIMEOUT_S)
        if check and done.returncode != 0:
            raise AssertionError(f"{command[0]} exits with {done.returncode}: {done.stdout}{done.stderr}")
        return done.stdout

    def wait_for(self, holds, what: str, seconds: float = 60) -> None:
        end = time.monotonic() + seconds
        while not holds():
            if time.monotonic() > end:
                logs = "".join(p.read_text(errors="replace")[-2000:] for p in self.folder.glob("*.log"))
                raise AssertionError(f"no {what} after {seconds} s\n{logs}")
            time.sleep(0.2)


def process_of(shard: Path) -> int | None:
    """Of the program that writes this part."""
    for entry in Path("/proc").iterdir():
        try:
            arguments = (entry / "cmdline").read_bytes().split(b"\0") if entry.name.isdigit() else []
        except OSError:
            continue
        if str(shard).encode() in arguments and arguments[0].endswith(b"spectrace"):
            return int(entry.name)
    return None


def small_scene(folder: Path) -> Path:
    text = (ROOT / "scenes/cornell_box.json").read_text()
    text = re.sub(r'"width": \d+, "height": \d+', '"width": 96, "height": 96', text)
    for name in ("meshes", "materials", "scene.schema.json"):
        (folder / name).symlink_to(ROOT / "scenes" / name)
    scene = folder / "box.json"
    scene.write_text(text)
    return scene


def submit(cluster: Cluster, scene: Path, out: Path) -> Path:
    """Queues a render in shards, and returns the folder of its parts."""
    print(cluster.run(str(ROOT / "scripts/slurm/render.sh"), str(scene), str(out), "--spp", str(SPP), "--shards",
                      str(SHARDS), "--checkpoint", "0.5"))
    return out.with_suffix(".parts")


def wait_for_checkpoint(cluster: Cluster, parts: Path, task: int) -> None:
    cluster.wait_for(lambda: (parts / f"{task}.partial").exists(), f"checkpoint of task {task}", 120)


def array_of(cluster: Cluster) -> str:
    return cluster.run("squeue", "-h", "--name=spectrace", "-o", "%F").split()[0]


def assert_resumed(parts: Path, task: int, code: int) -> None:
    log = (parts / f"{task}.log").read_text()
    assert f"exit code {code}: queued again" in log, log
    resumed = re.search(r"going on after (\d+) samples", log)
    assert resumed and int(resumed[1]) > 0, log
    print(f"task {task} ended with {code} and went on after {resumed[1]} samples")


def test_render(cluster: Cluster, spectrace: Path) -> None:
    folder = cluster.folder / "render"
    folder.mkdir()
    scene, out = small_scene(folder), folder / "out.exr"
    whole = folder / "whole.exr"
    cluster.run(str(spectrace), str(scene), "--spp", str(SPP), "-o", str(whole))
    parts = submit(cluster, scene, out)
    wait_for_checkpoint(cluster, parts, KILLED)
    victim = process_of(parts / f"{KILLED}.exr")
    assert victim is not None, "the task has ended before it could be killed"
    os.kill(victim, signal.SIGKILL)
    wait_for_checkpoint(cluster, parts, WARNED)
    # As --signal=B:TERM@120 does before a time limit, whose unit is a minute.
    cluster.run("scancel", "--batch", "--signal=TERM", f"{array_of(cluster)}_{WARNED}")
    cluster.wait_for(out.exists, "merged image", TIMEOUT_S)
    cluster.wait_for(lambda: not cluster.run("squeue", "-h"), "empty queue")
    assert_resumed(parts, KILLED, 137)
    assert_resumed(parts, WARNED, 5)
    print(cluster.run(str(spectrace), "compare", str(whole), str(out), "--max", "*.mse=0"))


def test_cancelled_is_not_queued_again(cluster: Cluster) -> None:
    folder = cluster.folder / "cancelled"
    folder.mkdir()
    parts = submit(cluster, small_scene(folder), folder / "out.exr")
    wait_for_checkpoint(cluster, parts, 0)
    cluster.run("scancel", array_of(cluster))
    cluster.wait_for(lambda: not cluster.run("squeue", "-h"), "empty queue after scancel", 120)
    log = (parts / "0.log").read_text()
    assert ": queued again" not in log, log
    assert not (folder / "out.exr").exists()


def test_bad_input_is_not_tried_again(cluster: Cluster) -> None:
    folder = cluster.folder / "bad"
    folder.mkdir()
    (folder / "scene.json").write_text("{")
    cluster.run(str(ROOT / "scripts/slurm/render.sh"), str(folder / "scene.json"), str(folder / "out.exr"), "--spp", "8",
                "--shards", "1")
    cluster.wait_for(lambda: not cluster.run("squeue", "-h"), "empty queue: neither tried again nor merged")
    log = (folder / "out.parts/0.log").read_text()
    assert "scene.json:" in log and "queued again" not in log, log
    assert not (folder / "out.exr").exists()


def test_separation(cluster: Cluster, spectrace: Path) -> None:
    folder = cluster.folder / "separation"
    (folder / "in").mkdir(parents=True)
    for name in ("pearlescent", "glossy"):
        source = ROOT / "scenes/materials" / f"{name}.json"
        cluster.run(str(spectrace), "acquire", str(source), "-o", str(folder / "in" / f"{name}.bsdf"), "--elevations", "6",
                    "--table", "8")
    print(cluster.run(str(ROOT / "scripts/slurm/separate.sh"), str(folder / "in"), str(folder / "out"), "--tasks", "2",
                      "--wait", "--", "--grid", "24x20x30"))
    made = sorted(p.stem for p in (folder / "out").glob("*.sep"))
    assert made == sorted(p.stem for p in (folder / "in").glob("*.bsdf")), made


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("spectrace", type=Path, help="the program")
    spectrace = parser.parse_args().spectrace.resolve()
    if os.geteuid() != 0:
        skip("starting Slurm's daemons needs root")
    if missing := [name for name in PROGRAMS if shutil.which(name) is None]:
        skip(f"not installed: {', '.join(missing)}")
    os.environ["SPECTRACE"] = str(spectrace)
    with tempfile.TemporaryDirectory(prefix="spectrace-slurm-") as folder, Cluster(Path(folder)) as cluster:
        test_render(cluster, spectrace)
        test_cancelled_is_not_queued_again(cluster)
        test_bad_input_is_not_tried_again(cluster)
        test_separation(cluster, spectrace)
    print("passed")


if __name__ == "__main__":
    main()
