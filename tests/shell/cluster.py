#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A cluster of one machine: munge, slurmctld and slurmd make eight shares of a sweep and of a movie, one task is
killed and put in the queue again, and what is joined is what one machine makes without them. Skipped where these
daemons are not installed or cannot start, as without root. cluster.py GEOMINT"""
import csv
import glob
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

geomint = os.path.realpath(sys.argv[1])
SHARES = 8
SWEEP = ["kepler", "eccentricity=0..0.9:10", "dt=2e-4..2e-3:log8", "scheme=verlet,rk4", "until=300"]
MOVIE = ["kepler", "scheme=verlet", "until=6", "--frames", "64", "--size", "160x90"]
PATIENCE = 240  # seconds


def skip(sentence):
    print("skipped:", sentence)
    sys.exit(77)


def wait_for(what, holds, patience=PATIENCE):
    until = time.monotonic() + patience
    while not holds():
        if time.monotonic() > until:
            return f"{what} took more than {patience} s"
        time.sleep(0.05)
    return None


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


def configure(folder):
    host = socket.gethostname().split(".")[0]
    controller, daemon = free_ports(2)
    path = os.path.join(folder, "slurm.conf")
    # a requeued task waits until its credential has expired
    with open(path, "w") as file:
        file.write(f"""ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={daemon}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1
MpiDefault=none
SwitchType=switch/none
ReturnToService=2
SlurmdParameters=config_overrides
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
""")
    os.environ["SLURM_CONF"] = path
    return path


def start(folder, daemons):
    for name in ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "sinfo"):
        if not shutil.which(name, path=os.environ["PATH"]):
            skip(f"{name} is not installed")
    if os.geteuid() != 0:
        skip("the daemons are started by root alone")
    configuration = configure(folder)
    with open(f"{folder}/munge.key", "wb") as key:
        key.write(os.urandom(1024))
    os.chmod(f"{folder}/munge.key", 0o400)
    munge = ["munged", "--foreground", "--force", f"--key-file={folder}/munge.key",
             f"--socket={folder}/munge.socket", f"--pid-file={folder}/munge.pid", f"--seed-file={folder}/munge.seed",
             f"--log-file={folder}/munge.log"]
    for words in (munge, ["slurmctld", "-D", "-f", configuration], ["slurmd", "-D", "-f", configuration]):
        log = open(f"{folder}/{words[0]}.out", "w")
        daemons.append(subprocess.Popen(words, stdout=log, stderr=log, stdin=subprocess.DEVNULL))
        if words is munge and wait_for("munge", lambda: os.path.exists(f"{folder}/munge.socket"), 20):
            skip("munge does not start: " + tail(f"{folder}/munged.out"))

    def is_idle():
        return "idle" in subprocess.run(["sinfo", "-h", "-o", "%t"], capture_output=True, text=True).stdout.split()

    if wait_for("slurm", is_idle, 60):
        skip("slurm does not start: " + tail(f"{folder}/slurmctld.out") + tail(f"{folder}/slurmd.out"))


def tail(path):
    with open(path, errors="replace") as file:
        return "".join(file.readlines()[-4:])


def submit(folder, name, command):
    """An array of one task a share; its number."""
    script = os.path.join(folder, f"{name}.slurm")
    with open(script, "w") as file:
        file.write(f"""#!/bin/sh
#SBATCH --array=1-{SHARES}
#SBATCH --ntasks=1
exec {command} --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT"
""")
    done = subprocess.run(["sbatch", "--parsable", "--requeue", f"--output={folder}/{name}-%a.out",
                           "--open-mode=append", script], capture_output=True, text=True, check=True)
    return done.stdout.strip()


def is_done(job):
    done = subprocess.run(["squeue", "-h", "-j", job, "-t", "PENDING,RUNNING,COMPLETING,CONFIGURING,REQUEUED"],
                          capture_output=True, text=True)
    return done.stdout.strip() == ""


def process_of(words):
    """The process that has these words among its arguments; None while there is none."""
    for path in glob.glob("/proc/[0-9]*/cmdline"):
        try:
            with open(path, "rb") as file:
                found = file.read().decode(errors="replace").split("\0")
        except OSError:
            continue
        if found[0] == geomint and all(word in found for word in words):
            return int(path.split("/")[2])
    return None


def rows(path):
    with open(path, newline="") as file:
        return [{key: value for key, value in row.items() if key != "seconds"} for row in csv.DictReader(file)]


def run(*words):
    done = subprocess.run([geomint, *words], capture_output=True, text=True)
    return None if done.returncode == 0 else f"{' '.join(words)}: {done.returncode} {done.stderr}"


def lines(path):
    if not os.path.exists(path):
        return 0
    with open(path, "rb") as file:
        return file.read().count(b"\n")


def work(folder):
    """What went wrong, as sentences."""
    shared = os.path.join(folder, "shared")
    os.mkdir(shared)
    table, frames = os.path.join(shared, "sweep.csv"), os.path.join(shared, "frames")
    job = submit(folder, "sweep", f"{geomint} sweep {' '.join(SWEEP)} --jobs 1 --table {table}")
    # the third task is killed in the middle of its share, and put in the queue again
    share = os.path.join(shared, f"sweep.3-of-{SHARES}.csv")
    faults = [wait_for("the third share", lambda: lines(share) >= 3)]
    victim = process_of(["--shard", f"3/{SHARES}", table])
    if victim:
        os.kill(victim, signal.SIGKILL)
    faults.append(None if victim else "the third task had ended before it could be killed")
    faults.append(wait_for("the end of the third task",
                           lambda: not victim or not os.path.exists(f"/proc/{victim}")))
    before = lines(share)
    movie = submit(folder, "movie", f"{geomint} render {' '.join(MOVIE)} --out {frames}")
    wait_for("the requeue", lambda: subprocess.run(["scontrol", "requeue", f"{job}_3"],
                                                   capture_output=True).returncode == 0, 30)
    faults.append(wait_for("the sweep", lambda: is_done(job)))
    faults.append(wait_for("the movie", lambda: is_done(movie)))
    faults.append(None if 0 < before < lines(share) else f"the third task did not go on: {before}, {lines(share)}")
    # joined, both are what one machine makes
    alone = os.path.join(folder, "alone")
    faults += [run("sweep", "--join", table),
               run("sweep", *SWEEP, "--table", os.path.join(alone, "sweep.csv")),
               run("render", *MOVIE, "--out", os.path.join(alone, "frames"))]
    if not any(faults):
        one, other = rows(table), rows(os.path.join(alone, "sweep.csv"))
        faults.append(None if len(one) == 160 and one == other else "the joined table is another one")
        names = sorted(os.listdir(os.path.join(alone, "frames")))
        made = sorted(name for name in os.listdir(frames) if name.endswith(".png"))
        faults.append(None if len(names) == 64 and made == names else f"{len(made)} frames, not {len(names)}")
        for name in names:
            with open(os.path.join(frames, name), "rb") as one, \
                    open(os.path.join(alone, "frames", name), "rb") as other:
                if one.read() != other.read():
                    faults.append(f"{name} is another picture")
    return [fault for fault in faults if fault]


os.environ["PATH"] += ":/usr/sbin:/sbin"
daemons, faults = [], []
folder = tempfile.mkdtemp()
os.chmod(folder, 0o755)
try:
    start(folder, daemons)
    faults = work(folder)
    for fault in faults:
        print("FAILED:", fault)
    if faults:
        for log in glob.glob(f"{folder}/*.out"):
            print(f"{os.path.basename(log)}:\n{tail(log)}")
finally:
    for daemon in reversed(daemons):
        daemon.terminate()
        try:
            daemon.wait(20)
        except subprocess.TimeoutExpired:
            daemon.kill()
            daemon.wait()
    shutil.rmtree(folder, ignore_errors=True)
sys.exit(1 if faults else 0)
