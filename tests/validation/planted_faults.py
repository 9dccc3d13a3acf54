#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Do the tests bite? Plants each fault below in a copy of the sources, rebuilds one test program and demands
that the named tests fail; unplanted, the same tests must pass.

    tests/validation/planted_faults.py [--only NAME ...] [--scratch FOLDER] [--into docs/validation.md]

Prints a table (Markdown); with --into it also takes the place of the table there. Exits with 1 where a fault
stays green, no longer applies, does not compile, or where a named test is absent or skipped.
"""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
from typing import NamedTuple

from tables import replace_table

ROOT = pathlib.Path(__file__).resolve().parents[2]


class Fault(NamedTuple):
    name: str
    file: str
    whole: str  # text that occurs once in the file
    broken: str  # what takes its place
    program: str  # target below tests/
    tests: str  # filter of googletest


SAMPLING = "All/EveryBsdfSampling.DrawsWhatItsDensitySays/"
CONTRACT = "All/EveryBsdfContract."
FAULTS = [
    Fault("wo and wi swapped in a measured BRDF's evaluate", "materials/measured_brdf.cpp",
          """  const Incident in = d.incident(wo);
  const std::optional<Half> half = d.half(in, wi);
  if (!half) return {};
""", """  const Incident in = d.incident(wi);
  const std::optional<Half> half = d.half(in, wo);
  if (!half) return {};
""", "statistical", CONTRACT + "WeightIsValueOverDensity/AcquiredPearlescent"),
    Fault("Jacobian of reflection dropped from a measured BRDF's density", "materials/measured_brdf.cpp",
          "std::max(u * sin_theta_m, kLeastPole) * 4 * wo_dot_wm)", "std::max(u * sin_theta_m, kLeastPole) * 4 * std::max(wo_dot_wm, Float(1)))",
          "statistical", SAMPLING + "AcquiredPearlescent"),
    Fault("Jacobian of reflection dropped from a separated BRDF's density", "materials/separated_sampler.cpp",
          "8 * kPi * dz_du(z) * static_cast<Float>(pair.cos_d))", "8 * kPi * dz_du(z))",
          "statistical", SAMPLING + "Separated_sun_wide"),
    Fault("horizon mask skipped in a measured BRDF's evaluate", "materials/measured_brdf.cpp",
          "  if (!(wo.z > 0 && wi.z > 0)) return {};\n", "  if (!(wo.z > 0)) return {};\n",
          "statistical", CONTRACT + "IsZeroInAndBelowTheHorizon/AcquiredPearlescent"),
    Fault("lobe chosen, its probability left out of the density", "materials/glossy.cpp",
          "lerp(wi.z * kInvPi, r.pdf, mix.specular_probability)", "wi.z * kInvPi + r.pdf",
          "statistical", SAMPLING + "GlossyPlastic"),
    Fault("weight not divided by the lobe's probability", "materials/glossy.cpp",
          ".weight = value.value_cos / value.pdf,",
          ".weight = value.value_cos * (choose_specular ? specular : 1 - specular) / value.pdf,",
          "statistical", CONTRACT + "WeightIsValueOverDensity/GlossyPlastic"),
    Fault("shadowing of wi left out of GGX reflection", "materials/microfacet.cpp",
          "d / (2 * (wo.z / wi.z * stretch_i + stretch_o))", "d / (2 * (wo.z + stretch_o)) + 0 * stretch_i",
          "statistical", CONTRACT + "IsReciprocal/RoughConductorAlpha08"),
    Fault("squared index left out of GGX refraction", "materials/microfacet.cpp",
          "r.pdf * masking(-wi) / sqr(eta)", "r.pdf * masking(-wi)",
          "statistical", CONTRACT + "ReflectsNoMoreThanItReceives/RoughGlassAlpha03"),
    Fault("number not stretched again after a mix has chosen by it", "materials/mix.cpp",
          "(choose_second ? u.lobe : u.lobe - w) / share", "u.lobe",
          "statistical", SAMPLING + "MixOfMixes"),
    Fault("theta_h off by one node", "materials/half_difference_grid.cpp",
          "const double x = i / n_theta_h;", "const double x = (i + 1) / n_theta_h;",
          "properties", "HalfDifferenceGrid.*"),
    Fault("theta_h taken for linear between squares", "materials/half_difference_grid.cpp",
          "(coordinate * coordinate - i * i) / (2 * i + 1)", "coordinate - i",
          "properties", "HalfDifferenceGrid.*"),
    Fault("azimuth of a half vector mirrored", "materials/half_difference.cpp",
          "const double along_b = (d.y * h.x - d.x * h.y) * h_norm;",
          "const double along_b = (d.x * h.y - d.y * h.x) * h_norm;", "properties", "HalfDifferenceAngles.*"),
    Fault("sum of samples in the order they came, not by halves", "renderer/sample_range.h",
          "for (; (count_ >> level & 1) != 0; ++level) {", "for (; level < levels_.size(); ++level) {",
          "properties", "SampleTree.*"),
    Fault("1/cos forgotten where a measurement becomes a table", "separation/tabulate.cpp",
          "1 / std::max(double(directions.wi.z), kLeastCosine)", "std::max(1.0, kLeastCosine)",
          "unit_separation", "Tabulate.*"),
    Fault("roulette: survivors not divided by their probability", "renderer/path_tracer.h",
          "        beta_ *= 1 / survival;\n", "",
          "render", "KnownRadiance.RouletteKeepsTheMean"),
    Fault("roulette takes refraction for loss", "renderer/path_tracer.h",
          "beta_.max() / radiance_scale_", "beta_.max()",
          "render", "KnownRadiance.RouletteDoesNotTakeRefractionForLoss"),
    Fault("light's density dropped from multiple importance sampling", "renderer/path_tracer.h",
          "weight = bsdf_mis_weight(pdf * scene_.lights.probability(point.light, last_receiver_));", "(void)pdf;",
          "render", "Estimators.LightSamplingKeepsTheMeanOfAreaLights"),
    Fault("wavelengths not ended by dispersion", "renderer/path_tracer.h",
          "        terminate_next_ = true;\n", "",
          "render", "Spectral.DispersingGlassKeepsTheFurnace"),
    Fault("a random number more where lobes may be delta lobes", "renderer/path_tracer.h",
          "    ++vertex_;\n    return goes_on;", "    vertex_ += kFeatures.delta_lobes ? 2 : 1;\n    return goes_on;",
          "render", "*EveryScene.KernelsChangeNoBit/*"),
    Fault("bins too wide by one part in their count", "renderer/spectral_bins.h",
          "return double(range.width_nm()) / double(count);", "return double(range.width_nm()) / double(count - 1);",
          "render", "SpectralFilm.BinsHoldTheMeanOfWhatIsThere"),
]


class Failure(Exception):
    pass


class Copy:
    """A copy of the sources that git knows of, as they are in the working tree, with a build of its own."""

    def __init__(self, folder: pathlib.Path):
        self.folder = folder
        listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT,
                                check=True, capture_output=True, text=True).stdout
        for name in filter(None, listed.split("\0")):
            source, target = ROOT / name, folder / name
            if not source.is_file():
                continue
            # What has not changed keeps its time: a second run builds only what did.
            if target.is_file() and target.read_bytes() == source.read_bytes():
                continue
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, target)
            shutil.copymode(source, target)
        self.run(["cmake", "--preset", "release", "-DSPECTRACE_BUILD_TESTS=ON"])

    def run(self, command: list[str]) -> None:
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise Failure(f"{' '.join(command[:3])} failed: {(done.stdout + done.stderr)[-1500:]}")

    def build(self, program: str) -> None:
        self.run(["cmake", "--build", "--preset", "release", "--target", program])

    def test(self, fault: Fault) -> tuple[bool, str]:
        """Whether all named tests passed, and the first that did not."""
        done = subprocess.run([str(self.folder / "build/release/tests" / fault.program),
                               f"--gtest_filter={fault.tests}", "--gtest_color=no"], cwd=self.folder,
                              capture_output=True, text=True, check=False, timeout=1800)
        ran = re.search(r"\[=+\] (\d+) tests? from \d+ test suites? ran", done.stdout)
        if not ran or int(ran.group(1)) == 0:
            raise Failure(f"no test ran: {fault.tests} (exit code {done.returncode})")
        if re.search(r"\[  SKIPPED \] \d+ test", done.stdout) and "[  FAILED  ]" not in done.stdout and \
                "[       OK ]" not in done.stdout:
            raise Failure(f"skipped: {fault.tests}")
        failed = re.search(r"^\[  FAILED  \] ([^\s,]+)", done.stdout, re.M)
        if (failed is None) != (done.returncode == 0):
            raise Failure(f"exit code {done.returncode} without a verdict: {fault.tests}")
        return failed is None, failed.group(1) if failed else ""

    def plant(self, fault: Fault) -> str:
        path = self.folder / fault.file
        text = path.read_text(encoding="utf-8")
        if text.count(fault.whole) != 1:
            raise Failure(f"no longer applies: {fault.file} holds the text {text.count(fault.whole)} times")
        path.write_text(text.replace(fault.whole, fault.broken), encoding="utf-8")
        return text


def seen_red(copy: Copy, fault: Fault) -> str:
    """The test that failed with the fault, having passed without it."""
    text = copy.plant(fault)
    try:
        copy.build(fault.program)
        passed, failed = copy.test(fault)
    finally:
        (copy.folder / fault.file).write_text(text, encoding="utf-8")
    if passed:
        raise Failure(f"stays green: {fault.tests}")
    return failed


def check_unplanted(copy: Copy, faults: list[Fault]) -> dict[str, str]:
    """What is wrong before anything is planted, by filter."""
    wrong = {}
    for program in dict.fromkeys(f.program for f in faults):
        copy.build(program)
    for fault in faults:
        try:
            passed, failed = copy.test(fault)
            if not passed:
                wrong[fault.name] = f"fails unplanted: {failed}"
        except Failure as failure:
            wrong[fault.name] = str(failure)
    return wrong


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="*", help="faults whose name contains one of these")
    parser.add_argument("--scratch", type=pathlib.Path, default=ROOT / "build/planted_faults")
    parser.add_argument("--into", type=pathlib.Path, help="a document whose table is replaced")
    arguments = parser.parse_args()
    faults = [f for f in FAULTS if not arguments.only or any(o in f.name for o in arguments.only)]

    try:
        copy = Copy(arguments.scratch.resolve())
        wrong = check_unplanted(copy, faults)
    except Failure as failure:
        print(failure, file=sys.stderr)
        return 1
    print(f"built and green without faults: {len(faults) - len(wrong)} of {len(faults)}", file=sys.stderr, flush=True)
    table = "| fault | planted in | turns red |\n|---|---|---|\n"
    for fault in faults:
        try:
            verdict = f"`{seen_red(copy, fault)}`" if fault.name not in wrong else f"**{wrong[fault.name]}**"
        except (Failure, subprocess.TimeoutExpired) as failure:
            wrong[fault.name] = str(failure)
            verdict = f"**{failure}**"
        row = f"| {fault.name} | `{fault.file}` | {verdict} |\n"
        print(row, end="", file=sys.stderr, flush=True)
        table += row
    print(table)
    if arguments.into and not wrong:
        replace_table(arguments.into, "planted faults", table)
    return 1 if wrong or not faults else 0


if __name__ == "__main__":
    os.environ.pop("GTEST_FILTER", None)
    sys.exit(main())
