"""A process that tries to reach a Ray cluster: Ray may wait for minutes or abort, which must not happen to its caller.

Prints one line of JSON: `{"cpus"}`, or `{"problem"}`. What Ray's native code has to say goes to stderr.
"""

import json
import logging
import sys

from ..types import Json


def probe(address: str) -> Json:
    """Connect, count cores, leave."""
    try:
        import ray

        ray.init(address=address, log_to_driver=False, logging_level=logging.CRITICAL)
        cores = ray.cluster_resources().get("CPU", 0.0)
        ray.shutdown()
    except (Exception, SystemExit) as problem:  # whatever Ray raises, its words are the answer
        return {"problem": " ".join(str(problem).split()) or type(problem).__name__}
    return {"cpus": cores}


if __name__ == "__main__":
    print(json.dumps(probe(sys.argv[1])))
