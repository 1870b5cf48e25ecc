"""What every peer in Python shares: rounds on demand."""

import json
import os
import sys
import time

THREADS = int(os.environ.get("BENCH_THREADS", "1"))


def serve(task, first_secs=0.0):
    """Prints that it is ready and `first_secs`, the seconds of a first run (0: not measured).

    Then for each line `go N` it does the task N times and prints how long that took.
    """
    print(json.dumps({"ready": True, "secs": first_secs}), flush=True)
    for line in sys.stdin:
        times = int(line.split()[1])
        start = time.perf_counter()
        for _ in range(times):
            task()
        print(json.dumps({"secs": time.perf_counter() - start}), flush=True)
