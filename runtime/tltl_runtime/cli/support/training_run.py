"""Set up the run of ``tltlc train``: a new training from its options, or a resumed one that agrees with them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from shlex import quote
from typing import Any, Literal, TypeVar

import click

from tltl_runtime.cli.support.initial_policy import (
    InitialPolicyOptions,
    check_initial_policy,
    level_of_policy,
    policy_difference,
    read_policy_option,
    with_policy_network,
    with_policy_path,
)
from tltl_runtime.cli.support.level_argument import check_level_exists, check_spelling, names_level, own_level
from tltl_runtime.cli.support.sensor_options import option_of
from tltl_runtime.cli.support.training_text import minutes
from tltl_runtime.evaluation.evaluate import check_limit
from tltl_runtime.game.level import default_spec
from tltl_runtime.game.level_name import parse_variant, split_level
from tltl_runtime.game.registry import game_of
from tltl_runtime.policies.compatibility import differences
from tltl_runtime.policies.identity import spec_hash
from tltl_runtime.spec.task import load_task, read_spec
from tltl_runtime.support.number_text import duration
from tltl_runtime.support.record_json import to_json
from tltl_runtime.training.files.checkpoint import read_checkpoint
from tltl_runtime.training.files.choices import Method
from tltl_runtime.training.files.run_file import (
    CHECKPOINT,
    MAY_CHANGE,
    RUN,
    TrainingRun,
    leaves,
    read_level_hash,
    read_run,
    resume_command,
)
from tltl_runtime.training.files.settings import TrainingSettings, read_settings
from tltl_runtime.training.files.settings_file import read_values
from tltl_runtime.training.imitation.demonstrations import recordings
from tltl_runtime.training.imitation.imitation_data import nothing_to_imitate
from tltl_runtime.training.ppo.distributed import process_group
from tltl_runtime.training.run.initial_policy import initial_policy_of
from tltlc.api import Diagnostic, Fspa, TltlError, fileio, record, replace

T = TypeVar("T")


@record
class TrainOptions:
    """The options of ``tltlc train``.

    An option that is not given is None; without sensor options, ``sensors`` is empty.
    """

    spec: str | None
    level: str | None
    seed: int | None
    config: Path | None
    steps: int | None
    minutes: float | None
    workers: int | Literal["ray"] | None
    device: str | None
    sensors: Mapping[str, Any]
    method: Method | None = None
    demonstrations: Path | None = None
    policy: Path | None = None


def new_run(options: TrainOptions, folder: Path | None) -> TrainingRun:
    """Set up a new training in ``folder``, by default a folder that is named after level, spec and seed.

    Raises:
        TltlError: the spec, the level, the sensors or the settings are invalid, or the initial policy
            does not fit them; TLT0873, the folder has files, but no training.
    """
    options = _with_named_level(options)
    if options.spec is not None:
        check_spelling(fileio.split_spec_name(options.spec)[0])
    initial = initial_policy_options(options)
    path, variant = _level_and_variant(options, initial)
    settings = new_settings(options, initial, path)
    _check_demonstrations(options.demonstrations, settings)
    game = game_of(path)
    level = game.load_level(path, variant)
    offered = game.params(level)
    spec: str | Fspa = options.spec or (initial.card.fspa if initial else default_spec(level))
    # If the policy's spec is used, keep the policy's parameters, except for those that the level supplies.
    known = initial.card.params if initial and options.spec is None else {}
    own = {name: value for name, value in known.items() if name not in offered}
    task = load_task(spec, own, offered=offered)
    game.check_fit(level, task.fspa, spec)
    check_limit(task.fspa)
    seed = options.seed or 0
    sensors = (
        game.choose_sensors(level, options.sensors or None)
        if initial is None
        else check_initial_policy(initial, level, task.fspa, options.sensors)
    )
    suffix = f"-{settings.method}" if settings.imitates else "-tuned" if initial else ""
    folder = folder or Path("training") / f"{level.name}-{level.variant}-{task.fspa.name}-{seed}{suffix}"
    _check_folder(folder)
    return TrainingRun(
        folder=folder,
        fspa=task.fspa,
        params=task.params,
        level=path,
        variant=parse_variant(variant),
        sensors=sensors,
        settings=settings,
        seed=seed,
        demonstrations=str(options.demonstrations) if options.demonstrations else None,
        initial=initial_policy_of(initial.path, initial.policy) if initial else None,
    )


def settings_to_print(options: TrainOptions) -> TrainingSettings:
    """Return the settings of a new training, also if the options do not say for which level.

    Raises the errors of :func:`initial_policy_options` and :func:`new_settings`.
    """
    initial, level = initial_policy_options(options), None
    with suppress(TltlError, click.UsageError):
        level, _ = _level_and_variant(_with_named_level(options), initial)
    return new_settings(options, initial, level)


def _with_named_level(options: TrainOptions) -> TrainOptions:
    """Return the options with a level in place of a spec, if the argument for the spec names a level."""
    if options.spec is None or not names_level(options.spec):
        return options
    if options.level is not None:
        raise _usage(f"`{options.spec}` is a level, and so is `{options.level}`: name a spec, or only one of them")
    return replace(options, level=options.spec, spec=None)


def initial_policy_options(options: TrainOptions) -> InitialPolicyOptions | None:
    """Return the policy with which a new training begins; None without the option ``--from``.

    Raises the errors of :func:`read_policy_option`.
    """
    return None if options.policy is None else read_policy_option(options.policy)


def new_settings(options: TrainOptions, initial: InitialPolicyOptions | None, level: str | None) -> TrainingSettings:
    """Return the settings of a new training; ``level`` is what it plays, None if that is unknown.

    Raises the errors of :func:`read_settings` and :func:`with_policy_network`.
    """
    settings = _with_limits(read_settings(options.config, level or ""), options)
    settings = replace(settings, method=_value_or(options.method, settings.method))
    return settings if initial is None else with_policy_network(settings, initial, options.config)


def resumed_run(options: TrainOptions, folder: Path) -> TrainingRun:
    """Set up the training in ``folder`` to be resumed.

    Only some settings may change. Level, demonstrations and initial policy must be the same, but their
    files may have moved.

    Raises:
        TltlError: the folder cannot be read; TLT0001, the level's file is missing; TLT0870, the options
            disagree with the training.
    """
    run = _with_level_place(read_run(folder), options)
    settings = run.settings if options.config is None else _with_file(run.settings, options.config)
    titles = list(_differences(run, options, settings))
    if titles:
        help_ = f"leave it out to continue the training in `{folder}`, or start another training with --out"
        raise TltlError([Diagnostic("TLT0870", title, help=help_) for title in titles])
    if options.demonstrations is not None:
        _check_demonstrations(options.demonstrations, settings)
        run = replace(run, demonstrations=str(options.demonstrations))
    if options.policy is not None:
        run = with_policy_path(run, options.policy)
    return replace(run, settings=_with_limits(settings, options))


def check_limits(run: TrainingRun) -> None:
    """Raise TltlError, TLT0862, if a new limit of a resumed training is already passed."""
    stop, before = run.settings.stop, read_run(run.folder).settings.stop
    checkpoint = None if stop == before else read_checkpoint(run.folder / CHECKPOINT)
    if checkpoint is None:
        return
    passed: list[tuple[str, str]] = []
    if stop.steps != before.steps and stop.steps <= checkpoint.steps:
        passed.append((f"done {checkpoint.steps:,} steps", f"{stop.steps:,} steps"))
    if stop.minutes != before.minutes and stop.is_out_of_time(checkpoint.seconds):
        passed.append((f"run for {duration(checkpoint.seconds)}", minutes(stop.minutes)))
    if passed:
        help_, where = "give a higher limit, or leave it out", f"the training in `{run.folder}`"
        titles = [f"{where} has {done}, and a limit of {limit} would end it at once" for done, limit in passed]
        raise TltlError([Diagnostic("TLT0862", title, help=help_) for title in titles])


def _level_and_variant(options: TrainOptions, initial: InitialPolicyOptions | None) -> tuple[str, str]:
    """Return the level and the variant of a new training.

    They are from ``--level``, else from the spec, else from the policy.
    """
    if options.level is not None:
        path, variant = split_level(options.level)
        return path, variant or "v0"
    if options.spec is not None:
        return own_level(options.spec), "v0"
    if initial is not None and options.policy is not None:
        return level_of_policy(options.policy, initial)
    raise _usage("say what to train for: a spec, a level, or both")


def _with_level_place(run: TrainingRun, options: TrainOptions) -> TrainingRun:
    """Return the training with the level's path from ``--level``, because the level may have moved.

    If ``--level`` names another level, return the training unchanged. Without ``--level``, raise
    TltlError, TLT0001, if the file of the training's level is missing.
    """
    if options.level is None:
        check_level_exists(run.level, run.variant.text, resume_command(run.folder))
        return run
    path, variant = split_level(options.level)
    game = game_of(path)
    if game.level_hash(game.load_level(path, variant or "v0")) != read_level_hash(run.folder):
        return run
    return replace(run, level=path, variant=parse_variant(variant or "v0"))


def _level_place(level: str) -> tuple[Path, str]:
    """Return the path of a level's file, and the level's name, because a game file may contain several scenes."""
    level_files = game_of(level).level_files
    return level_files.path(level).resolve(), level_files.level_name(level)


def _check_folder(folder: Path) -> None:
    """Raise TltlError, TLT0873, if the folder has files, but no training.

    The files could be lost when the user deletes the training later.
    """
    if process_group().rank > 0 or not folder.is_dir() or (folder / RUN).exists():
        return
    try:
        names = sorted(path.name for path in folder.iterdir() if not path.name.startswith("."))
    except OSError as error:
        raise fileio.reading_error(str(folder), error) from None
    if names:
        title = f"`{folder}` is not a training, and contains other files: `{names[0]}`{' and more' * (len(names) > 1)}"
        help_ = f"name a folder of its own, e.g. `--out {quote(str(folder / 'training'))}`"
        raise TltlError([Diagnostic("TLT0873", title, help=help_)])


def _check_demonstrations(folder: Path | None, settings: TrainingSettings) -> None:
    """Check the folder of demonstrations.

    Raises:
        UsageError: the method does not use demonstrations.
        TltlError: TLT0921, the folder contains no recordings.
    """
    if folder is None:
        return
    if not settings.imitates:
        raise _usage("--demonstrations works only with --method imitation")
    if not recordings(folder):
        raise nothing_to_imitate(folder, [])


def _usage(message: str) -> click.UsageError:
    return click.UsageError(message, click.get_current_context())


def _with_file(settings: TrainingSettings, path: Path) -> TrainingSettings:
    """Return ``settings`` with the values that the settings file ``path`` sets.

    Raises:
        TltlError: the file cannot be read, or has a wrong key or value (TLT0860 to TLT0862).
    """
    for table, values in read_values(fileio.read_source(path)).items():
        changed = {table: replace(getattr(settings, table), **values)} if table else values
        settings = replace(settings, **changed)
    return settings


def _with_limits(settings: TrainingSettings, options: TrainOptions) -> TrainingSettings:
    """Return ``settings`` with the limits, workers and device that ``options`` set."""
    stop, rollout = settings.stop, settings.rollout
    if options.workers == "ray":
        rollout = replace(rollout, pool="ray")
    elif options.workers is not None:
        rollout = replace(rollout, pool="processes", workers=options.workers)
    return replace(
        settings,
        stop=replace(
            stop, steps=_value_or(options.steps, stop.steps), minutes=_value_or(options.minutes, stop.minutes)
        ),
        rollout=rollout,
        device=_value_or(options.device, settings.device),
    )


def _value_or(value: T | None, default: T) -> T:
    return default if value is None else value


def _differences(run: TrainingRun, options: TrainOptions, settings: TrainingSettings) -> Iterator[str]:
    """Yield a sentence for each option that contradicts the training to be resumed."""
    where = f"the training in `{run.folder}`"
    if options.level is not None:
        path, variant = split_level(options.level)
        ours = _level_place(run.level), run.variant.absolute()
        if (_level_place(path), parse_variant(variant or "v0").absolute()) != ours:
            yield f"{where} is on the level `{run.level}:{run.variant.text}`, not on `{path}:{variant or 'v0'}`"
    if options.spec is not None:
        fspa, _ = read_spec(options.spec)
        if spec_hash(fspa) != spec_hash(run.fspa) and fspa.name == run.fspa.name:
            details = differences(run.fspa, fspa)
            yield f"{where} is for another spec `{fspa.name}` than the one in `{options.spec}`: {details}"
        elif spec_hash(fspa) != spec_hash(run.fspa):
            yield f"{where} is for the spec `{run.fspa.name}`, not for `{fspa.name}` of `{options.spec}`"
    if options.seed is not None and options.seed != run.seed:
        yield f"{where} has the seed {run.seed}, not {options.seed}"
    if options.method is not None and options.method != run.settings.method:
        yield f"{where} uses the method `{run.settings.method}`, not `{options.method}`"
    if options.policy is not None and (difference := policy_difference(run, options.policy)):
        yield difference
    game, sensors = game_of(run.level), run.sensors
    if options.sensors:
        sensors = game.choose_sensors(game.load_level(run.level, run.variant), options.sensors)
    # Sensors without an option stay as they are in the training, whatever the level's own sensors are.
    for key in options.sensors:
        if getattr(sensors, key) != getattr(run.sensors, key):
            own_option, option = option_of(key, run.sensors), option_of(key, sensors)
            yield f"{where} has the sensors of `{own_option}`, not those of `{option}`"
    requested = dict(leaves(to_json(settings)))
    for path, value in leaves(to_json(run.settings)):
        if path not in MAY_CHANGE and value != requested[path]:
            yield f"{where} has another value of `{path}` than `{options.config}`"
