#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Times `spectrace separate` from `.bsdf` on disk to `.sep`, at 3, 31 and all wavelengths of one measurement.

Usage: separation_speed.py PROGRAM FILE.bsdf [--runs N] [--threads N] [FURTHER OPTIONS OF separate]

Prints the medians of wall and CPU time over the runs, the most memory any of them held, the steps' seconds of the run
of median wall time, and how nearly the CPU time is a line in the number of wavelengths.
"""
import argparse
import json
import os
import statistics
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

MAGIC = b"tensor_file\0"
SIZES = {1: 1, 2: 1, 3: 2, 4: 2, 5: 4, 6: 4, 7: 8, 8: 8, 9: 2, 10: 4, 11: 8}  # bytes by type (docs/file-formats.md)


def read_tensors(path):
    """{name: (type, shape, bytes)} of a tensor file."""
    data = path.read_bytes()
    if not data.startswith(MAGIC):
        sys.exit(f"{path}: not a tensor file")
    (count,) = struct.unpack_from("<I", data, 14)
    at, tensors = 18, {}
    for _ in range(count):
        (length,) = struct.unpack_from("<H", data, at)
        name = data[at + 2 : at + 2 + length].decode()
        at += 2 + length
        dimensions, kind, offset = struct.unpack_from("<HBQ", data, at)
        shape = struct.unpack_from(f"<{dimensions}Q", data, at + 11)
        at += 11 + 8 * dimensions
        size = SIZES[kind]
        for n in shape:
            size *= n
        tensors[name] = (kind, shape, data[offset : offset + size])
    return tensors


def write_tensors(path, tensors):
    header_size = 18 + sum(13 + len(name) + 8 * len(shape) for name, (_, shape, _) in tensors.items())
    header, body = bytearray(MAGIC + bytes([1, 0]) + struct.pack("<I", len(tensors))), bytearray()
    for name, (kind, shape, data) in tensors.items():
        header += struct.pack("<H", len(name)) + name.encode()
        header += struct.pack("<HBQ", len(shape), kind, header_size + len(body))
        header += struct.pack(f"<{len(shape)}Q", *shape)
        body += data
    path.write_bytes(header + body)


def with_wavelengths(tensors, wanted):
    """The same measurement at `wanted` of its wavelengths, evenly chosen from the first to the last."""
    kind, shape, data = tensors["spectra"]
    phi, theta, axis, rows, columns = shape
    chosen = [round(k * (axis - 1) / (wanted - 1)) for k in range(wanted)]
    table = SIZES[kind] * rows * columns
    spectra = b"".join(
        data[(slice_ * axis + k) * table : (slice_ * axis + k + 1) * table]
        for slice_ in range(phi * theta)
        for k in chosen
    )
    lambda_kind, _, lambdas = tensors["wavelengths"]
    step = SIZES[lambda_kind]
    picked = b"".join(lambdas[k * step : (k + 1) * step] for k in chosen)
    return tensors | {
        "spectra": (kind, (phi, theta, wanted, rows, columns), spectra),
        "wavelengths": (lambda_kind, (wanted,), picked),
    }


def run_once(program, source, folder, options):
    """Wall and CPU seconds, peak memory in bytes, and the seconds of each step."""
    report = folder / "report.json"
    command = [program, "separate", str(source), "-o", str(folder / "out.sep"), "--report", str(report), *options]
    start = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    wall = time.monotonic() - start
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"exit code {process.returncode}: {' '.join(command)}")
    return {
        "wall": wall,
        "cpu": usage.ru_utime + usage.ru_stime,
        "bytes": usage.ru_maxrss * 1024,
        "steps": json.loads(report.read_text())["seconds"],
    }


def fit_line(points):
    """Least squares through (x, y): intercept, slope, largest relative deviation."""
    mean_x = statistics.fmean(x for x, _ in points)
    mean_y = statistics.fmean(y for _, y in points)
    slope = sum((x - mean_x) * (y - mean_y) for x, y in points) / sum((x - mean_x) ** 2 for x, _ in points)
    intercept = mean_y - slope * mean_x
    return intercept, slope, max(abs(y / (intercept + slope * x) - 1) for x, y in points)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("program")
    arguments.add_argument("file", type=Path)
    arguments.add_argument("--runs", type=int, default=5)
    arguments.add_argument("--threads", type=int, default=0)
    given, further = arguments.parse_known_args()
    tensors = read_tensors(given.file)
    if "spectra" not in tensors:
        sys.exit(f"{given.file}: no spectra")
    all_wavelengths = tensors["spectra"][1][2]
    options = ["--threads", str(given.threads), *further]

    print(f"{given.file.name}, {given.runs} runs each, load {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors")
    print(f"{'wavelengths':>11} {'wall [s]':>9} {'cpu [s]':>8} {'peak [MB]':>9}  steps [s] of the median run")
    points = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        source = folder / "measured.bsdf"
        for wanted in sorted({n for n in (3, 31, all_wavelengths) if n <= all_wavelengths}):
            write_tensors(source, tensors if wanted == all_wavelengths else with_wavelengths(tensors, wanted))
            runs = sorted((run_once(given.program, source, folder, options) for _ in range(given.runs)),
                          key=lambda run: run["wall"])
            median = runs[(len(runs) - 1) // 2]
            cpu = statistics.median(run["cpu"] for run in runs)
            peak = max(run["bytes"] for run in runs)
            points.append((wanted, cpu))
            steps = ", ".join(f"{step} {seconds:.2f}" for step, seconds in median["steps"].items())
            print(f"{wanted:>11} {median['wall']:>9.2f} {cpu:>8.2f} {peak * 1e-6:>9.0f}  {steps}", flush=True)
    if len(points) > 2:
        intercept, slope, worst = fit_line(points)
        print(f"cpu = {intercept:.2f} s + {1000 * slope:.1f} ms a wavelength; within {100 * worst:.1f} % of that line")
    print(f"load afterwards {os.getloadavg()[0]:.1f}")


if __name__ == "__main__":
    main()
