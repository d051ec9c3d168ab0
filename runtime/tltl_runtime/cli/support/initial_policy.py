"""`tltlc train --from POLICY`: the initial policy, and what it determines: spec, sensors, network and level."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import click

from tltl_runtime.cli.support.policy_path import check_level_is_shipped, policy_file, policy_place
from tltl_runtime.cli.support.sensor_options import option_of
from tltl_runtime.game.level import Level
from tltl_runtime.game.sensors import Sensors
from tltl_runtime.policies.card import Card
from tltl_runtime.policies.compatibility import check_policy
from tltl_runtime.policies.file import read_policy
from tltl_runtime.policies.policy import Policy
from tltl_runtime.training.files.run_file import TrainingRun
from tltl_runtime.training.files.settings import TrainingSettings
from tltl_runtime.training.files.settings_file import read_values
from tltl_runtime.training.run.initial_policy import weights_hash
from tltlc.api import Diagnostic, Fspa, TltlError, fileio, record, replace

_COMMAND = "tltlc train --from"


@record
class InitialPolicyOptions:
    """The policy with which a training begins, and the path of its file."""

    policy: Policy
    path: Path

    @property
    def card(self) -> Card:
        """The policy's card, which describes what it was trained for."""
        return self.policy.card


def read_policy_option(named: Path) -> InitialPolicyOptions:
    """Read the policy that ``--from`` names.

    ``named`` is the file of a policy, the folder of a training, or the name of a level, as for
    ``tltlc evaluate``. Raises TltlError if the policy cannot be read.
    """
    path = policy_file(named)
    return InitialPolicyOptions(read_policy(path), path)


def level_of_policy(named: Path, initial: InitialPolicyOptions) -> tuple[str, str]:
    """Return the level and the variant that the policy ``named`` was trained on.

    ``initial`` is the same policy, already read. Raises TltlError if the file of the level is unknown
    or missing.
    """
    path, name, variant = policy_place(named, None, _COMMAND)
    if name is None:
        check_level_is_shipped(initial.card, path, _COMMAND)
        name, variant = initial.card.level, initial.card.variant
    return name, variant or "v0"


def with_policy_network(
    settings: TrainingSettings, initial: InitialPolicyOptions, config: Path | None
) -> TrainingSettings:
    """Return the training settings with the network of the initial policy.

    Raises:
        TltlError: TLT0941, the file ``config`` sets another network.
        UsageError: the settings are for imitation.
    """
    if settings.imitates:
        message = "--from works only with the method `automaton`: an agent that imitates starts from demonstrations"
        raise click.UsageError(message, click.get_current_context())
    network = initial.card.network
    network_settings = {} if config is None else read_values(fileio.read_source(config)).get("network", {})
    if replace(network, **network_settings) != network:
        title = f"the network of `{initial.path}` is not the one that `[network]` in `{config}` describes"
        raise TltlError([Diagnostic("TLT0941", title, help=f"remove `[network]` from `{config}`, or leave out --from")])
    return replace(settings, network=network)


def check_initial_policy(
    initial: InitialPolicyOptions, level: Level, fspa: Fspa, sensor_options: Mapping[str, Any]
) -> Sensors:
    """Check that the initial policy fits the training; return its sensors, which the agent uses.

    ``sensor_options`` maps the sensors that command-line options set, such as ``map``, to their values.

    Raises:
        TltlError: TLT0843, the policy does not fit the level or the spec; TLT0941, the options ask for
            other sensors.
    """
    check_policy(initial.card, level, fspa)
    titles = list(_sensor_differences(initial, level, sensor_options))
    if titles:
        help_ = "leave out the option, or train without --from"
        raise TltlError([Diagnostic("TLT0941", title, help=help_) for title in titles])
    return initial.card.sensors


def policy_difference(run: TrainingRun, named: Path) -> str | None:
    """Return a sentence if a training did not start with the policy ``named``; None if it did."""
    where = f"the training in `{run.folder}` begins with"
    if run.initial is None:
        return f"{where} random weights, not with the policy `{named}`"
    same = weights_hash(read_policy(policy_file(named))) == run.initial.weights
    return None if same else f"{where} another policy than `{named}`"


def with_policy_path(run: TrainingRun, named: Path) -> TrainingRun:
    """Return a training whose initial policy has the path of the policy ``named``: the file may have moved."""
    assert run.initial is not None
    return replace(run, initial=replace(run.initial, path=str(policy_file(named))))


def _sensor_differences(
    initial: InitialPolicyOptions, level: Level, sensor_options: Mapping[str, Any]
) -> Iterator[str]:
    """Yield a sentence for each option that asks for other sensors than those of the policy."""
    own = initial.card.sensors
    sensors = level.game.choose_sensors(level, sensor_options) if sensor_options else own
    for key in sensor_options:
        if getattr(sensors, key) != getattr(own, key):
            own_option, option = option_of(key, own), option_of(key, sensors)
            yield f"`{initial.path}` has the sensors of `{own_option}`, not those of `{option}`"
