"""Items over a Ray cluster, whose workers and nodes may die. Ray is optional and imported inside functions only."""

import importlib.util
import json
import logging
import os
import re
import socket
import subprocess
import sys
import time
from collections import Counter, deque
from collections.abc import Generator, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Final

from ..errors import StatedError, how_to_install
from ..types import Json
from .executor import MOST_TRIES, End
from .release import difference, release
from .worker import find_function, run_item

CONNECT: Final = 3.0
"""Longest wait for the cluster's port [s]."""
ANSWER: Final = 20.0
"""Longest wait for the cluster's answer behind that port [s]."""
AHEAD: Final = 2
"""Items in flight for each core: one at work and one waiting."""
RECOUNT: Final = 5.0
"""How often the cores are counted, for nodes may join and leave [s]."""
UNAUTHENTICATED: Final = re.compile("Unauthenticated|AuthToken|AuthenticationError|authentication token", re.IGNORECASE)
ALLOWED: Final = "write the HOST:PORT that `ray start --head` printed, such as 10.0.0.5:6379"


class ClusterError(StatedError):
    """There is no cluster to run on, it is no good for us, or it was lost."""

    says = "--ray {address}: {problem}; {allowed}"
    address: str
    problem: str
    allowed: str


@dataclass(frozen=True, slots=True)
class RayCluster:
    """A running Ray cluster of which this machine is a node; Clamber joins one and never starts one."""

    address: str
    """HOST:PORT of its head."""
    workers: int | None = None
    """Items at work at once; None: as many as the cluster has cores."""

    @property
    def here(self) -> bool:
        """False."""
        return False

    def check(self) -> None:
        """Makes sure that a cluster answers there, within seconds.

        Raises:
            ClusterError: If the address is none, Ray is not installed, nothing answers, the token is wrong, or the versions
                of Ray or Python differ.
        """
        host, port = self._place()
        if importlib.util.find_spec("ray") is None:
            raise ClusterError(self.address, "Ray is not installed here", f"install it with: {how_to_install('ray')}")
        try:
            socket.create_connection((host, port), timeout=CONNECT).close()
        except OSError as error:
            why = error.strerror or str(error)
            raise ClusterError(self.address, f"nothing answers there ({why})", ALLOWED) from None
        command = [sys.executable, "-m", "clamber.jobs.probe", self.address]
        try:
            done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=ANSWER)
            out, said = done.stdout, done.stderr
        except subprocess.TimeoutExpired as error:
            out, said = "", (error.stderr or b"").decode(errors="replace")
        try:
            told: Json = json.loads(out.splitlines()[-1])
        except (ValueError, IndexError):
            told = {"problem": f"no Ray cluster answered within {ANSWER:.0f} s"}
        if "problem" in told and UNAUTHENTICATED.search(told["problem"] + said):
            raise ClusterError(
                self.address,
                "the cluster refuses this process: its token is missing or wrong",
                "set RAY_AUTH_MODE=token, and RAY_AUTH_TOKEN_PATH to the file of the cluster's token",
            )
        if "problem" in told:
            raise ClusterError(self.address, told["problem"], "see docs/scaling.md for how to start a cluster")
        if not told["cpus"]:
            raise ClusterError(self.address, "the cluster has no cores", "start a node with `ray start --address`")

    def _place(self) -> tuple[str, int]:
        host, _, port = self.address.rpartition(":")
        if not host or "/" in host or not port.isdecimal() or not 0 < int(port) < 2**16:
            raise ClusterError(self.address, "is no address of a Ray cluster", ALLOWED)
        return host.strip("[]"), int(port)

    def run(self, name: str, items: Mapping[str, str]) -> Generator[End]:
        """See `Executor`.

        Raises:
            ClusterError: If the cluster can't be joined, or its workers have no Clamber or another one.
        """
        if not items:
            return
        os.environ.setdefault("RAY_BACKEND_LOG_LEVEL", "fatal")  # else native code writes into the user's terminal
        import ray

        try:
            with _silent_stderr():
                ray.init(
                    address=self.address,
                    log_to_driver=False,
                    logging_level=logging.CRITICAL,
                    runtime_env={"env_vars": {"OPENBLAS_NUM_THREADS": "1"}},  # as local workers have it
                )
        except Exception as error:
            raise ClusterError(self.address, " ".join(str(error).split()), "see docs/scaling.md") from None
        try:
            yield from self._run(name, items)
        finally:
            ray.shutdown()  # ends what is at work

    def _run(self, name: str, items: Mapping[str, str]) -> Generator[End]:
        import ray
        from ray.exceptions import RayError, RayTaskError

        # Ray must not repeat items by itself: it would count no tries, and repeat those that ended
        task = ray.remote(run_there).options(num_cpus=1, max_retries=0)
        mine = json.dumps(release())
        queue = deque(items)
        tries: Counter[str] = Counter()
        pending: dict[Any, str] = {}
        room, counted = 0, -RECOUNT
        while queue or pending:
            if time.monotonic() - counted > RECOUNT:
                cores = int(ray.cluster_resources().get("CPU", 0.0))
                room, counted = self.workers or max(1, AHEAD * cores), time.monotonic()
            while queue and len(pending) < room:
                key = queue.popleft()
                tries[key] += 1
                pending[task.remote(name, items[key], mine)] = key
            ended, _ = ray.wait(list(pending), num_returns=1, timeout=RECOUNT)
            if ended:
                ended, _ = ray.wait(list(pending), num_returns=len(pending), timeout=0.0)
            for one in ended:
                key = pending.pop(one)
                try:
                    told = json.loads(ray.get(one))
                except RayTaskError as error:  # nothing of an item raises there: the worker has no such function
                    raise ClusterError(
                        self.address,
                        f"a worker can't run '{name}' ({type(error.cause).__name__}: {error.cause})",
                        "install the same Clamber on every node",
                    ) from None
                except RayError as error:
                    if tries[key] < MOST_TRIES:
                        queue.append(key)
                        continue
                    died = f"its worker on the cluster died {MOST_TRIES} times, {type(error).__name__}"
                    told = {"result": None, "seconds": 0.0, "error": died}
                if "release" in told:
                    raise ClusterError(
                        self.address,
                        f"a worker on {told['host']} has another release: {difference(release(), told['release'])}",
                        "install the same Clamber, Python, NumPy, Numba and MuJoCo on every node",
                    )
                yield End(key, told["result"], told["seconds"], told["error"], tries[key])


def run_there(name: str, item: str, asked: str) -> str:
    """Runs in a worker of the cluster: the end of one item, or the worker's release if that isn't the one asked for."""
    if json.dumps(here := release()) != asked:
        return json.dumps({"release": here, "host": socket.gethostname()})
    return json.dumps(run_item(find_function(name), item))


@contextmanager
def _silent_stderr() -> Iterator[None]:
    """Ray's native code announces itself on the process's stderr, whatever its settings."""
    sys.stderr.flush()
    kept, nowhere = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 2)
    try:
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(nowhere)
