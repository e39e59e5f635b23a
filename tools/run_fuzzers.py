#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs all fuzzers, two at a time, and prints a table of their results."""
import argparse
import concurrent.futures
import os
import re
import subprocess
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

SOURCES = Path(__file__).resolve().parent
AT_A_TIME = 2
SECONDS_A_FILE = 10  # a longer run of one file is a finding
MEMORY_MB = 1500  # limit of the process, with libraries and sanitizers
ALLOCATION_MB = 300  # limit of a single allocation
LARGEST_FILE = 1 << 16
MAX_FINDINGS = 5  # after this number of findings a target ends


@dataclass
class Outcome:
    """Results of a target, summed over all of its starts."""
    target: str
    runs: int = 0
    seconds: float = 0.0
    coverage: int = 0
    memory_mb: int = 0
    slowest_seconds: int = 0
    findings: list[str] = field(default_factory=list)

    def add(self, log: str) -> None:
        def last(pattern: str) -> int:
            found = re.findall(pattern, log)
            return int(found[-1]) if found else 0
        # An interrupted run prints its progress, but no statistics.
        self.runs += last(r'stat::number_of_executed_units: *(\d+)') or last(r'\n#(\d+)')
        self.coverage = max(self.coverage, last(r' cov: (\d+)'))
        self.memory_mb = max(self.memory_mb, last(r'stat::peak_rss_mb: *(\d+)') or last(r' rss: (\d+)'))
        self.slowest_seconds = max(self.slowest_seconds, last(r'stat::slowest_unit_time_sec: *(\d+)'))
        self.findings += [f for f in re.findall(r'Test unit written to (\S+)', log) if f not in self.findings]


def run_target(fuzzer: Path, folder: Path, seconds: float) -> Outcome:
    """Runs a target until the time is over, and restarts it after each finding. Files that reach
    new lines are kept in a folder, and the next run starts with them."""
    corpus, findings = folder / 'corpus' / fuzzer.name, folder / 'findings'
    for needed in (corpus, findings):
        needed.mkdir(parents=True, exist_ok=True)
    outcome = Outcome(fuzzer.name)
    begin = time.monotonic()
    while (left := seconds - (time.monotonic() - begin)) > 1 and len(outcome.findings) < MAX_FINDINGS:
        command = [fuzzer, corpus, SOURCES / 'corpus' / fuzzer.name,
                   f'-max_total_time={int(left)}', f'-timeout={SECONDS_A_FILE}',
                   f'-rss_limit_mb={MEMORY_MB}', f'-malloc_limit_mb={ALLOCATION_MB}',
                   f'-max_len={LARGEST_FILE}', '-print_final_stats=1',
                   f'-artifact_prefix={findings}/{fuzzer.name}-']
        run = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                             env=os.environ | {'OMP_NUM_THREADS': '1'}, check=False)
        log = run.stdout.decode(errors='replace')
        (folder / f'{fuzzer.name}.log').write_text(log)
        known = len(outcome.findings)
        outcome.add(log)
        if run.returncode != 0 and len(outcome.findings) == known:  # a repeated finding, or no finding
            outcome.findings += [] if known else [f'see {folder}/{fuzzer.name}.log']
            break
    outcome.seconds = time.monotonic() - begin
    return outcome


def print_table(outcomes: list[Outcome]) -> None:
    row = '{:<11}{:>11}{:>8}{:>10}{:>11}{:>11}{:>10}'
    print(row.format('target', 'runs', 'runs/s', 'coverage', 'memory MB', 'slowest s', 'findings'))
    for o in outcomes:
        print(row.format(o.target, o.runs, round(o.runs / max(o.seconds, 1.0)), o.coverage, o.memory_mb,
                         o.slowest_seconds, len(o.findings)))
    for o in outcomes:
        for finding in o.findings:
            print(f'{o.target}: {finding}')


def main() -> int:
    parser = argparse.ArgumentParser(prog='run fuzz', description=__doc__)
    parser.add_argument('--minutes', type=float, default=20.0,
                        help='minutes for all targets together (default: %(default)g)')
    parser.add_argument('--build', type=Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument('targets', nargs='*', help='targets to run (default: all)')
    arguments = parser.parse_args()
    known = {f.name: f for f in sorted((arguments.build / 'fuzz' / 'fuzzers').iterdir())}
    for target in arguments.targets:
        if target not in known:
            parser.error(f"there is no target '{target}'; choose from {', '.join(known)}")
    fuzzers = [known[target] for target in arguments.targets or known]
    folder = arguments.build / 'fuzz' / 'runs'
    seconds = 60 * arguments.minutes * min(AT_A_TIME, len(fuzzers)) / len(fuzzers)
    print(f'{len(fuzzers)} targets, {seconds:.0f} s each')
    with concurrent.futures.ThreadPoolExecutor(AT_A_TIME) as pool:
        outcomes = list(pool.map(lambda f: run_target(f, folder, seconds), fuzzers))
    print_table(outcomes)
    return 1 if any(o.findings for o in outcomes) else 0


if __name__ == '__main__':
    sys.exit(main())
