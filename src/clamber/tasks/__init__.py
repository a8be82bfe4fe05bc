"""Tasks: a robot in a world, a start, rules, goals; read from files, with overrides, and rebuilt from stored text."""

from .library import Task as Task
from .library import load_task as load_task
from .library import task_from_document as task_from_document
from .library import task_names as task_names
