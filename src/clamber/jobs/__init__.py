"""Many independent items of work over local processes; it knows no robots."""

from .pool import Outcome as Outcome
from .pool import map_items as map_items
from .store import StoreError as StoreError
