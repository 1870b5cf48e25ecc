"""What every peer in Python shares: rounds on demand."""

import json
import os
import sys
import time

THREADS = int(os.environ.get("BENCH_THREADS", "1"))


def serve(task, first_secs=0.0):
    """Says that all is ready and how long the first run took, then does the task as often as each line asks and says how long that took."""
    print(json.dumps({"ready": True, "secs": first_secs}), flush=True)
    for line in sys.stdin:
        times = int(line.split()[1])
        start = time.perf_counter()
        for _ in range(times):
            task()
        print(json.dumps({"secs": time.perf_counter() - start}), flush=True)
