"""Many independent items of work over local processes or a cluster; it knows no robots."""

from .batch import Kept as Kept
from .batch import Outcome as Outcome
from .batch import look_into as look_into
from .batch import map_items as map_items
from .batch import read_result as read_result
from .cluster import ClusterError as ClusterError
from .cluster import RayCluster as RayCluster
from .executor import Executor as Executor
from .local import LocalProcesses as LocalProcesses
from .store import StoreError as StoreError
