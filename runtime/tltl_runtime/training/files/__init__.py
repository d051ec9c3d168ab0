"""The files in the folder of a training: settings, checkpoint, metrics and record, and the classes that they store.

Begin with :mod:`~tltl_runtime.training.files.run_file`, which names them.
"""
