"""`tltlc train --from POLICY`: the initial policy, and what it determines: spec, sensors, network and level."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import click

from tltl_runtime.cli.support.policy_path import check_known, policy_file, policy_place
from tltl_runtime.cli.support.sensor_options import option_of
from tltl_runtime.policies.card import Card
from tltl_runtime.policies.file import read_policy
from tltl_runtime.policies.fit import check_policy
from tltl_runtime.policies.policy import Policy
from tltl_runtime.stealth.level import Level, Sensors
from tltl_runtime.stealth.observation.sensors import chosen
from tltl_runtime.training.run.initial_policy import weights_hash
from tltl_runtime.training.run.run_file import TrainingRun
from tltl_runtime.training.run.settings import TrainingSettings
from tltl_runtime.training.run.settings_file import read_values
from tltlc.api import Diagnostic, Fspa, TltlError, fileio, record, replace

_COMMAND = "tltlc train --from"


@record
class InitialPolicyOptions:
    """An initial policy and its file."""

    policy: Policy
    path: Path

    @property
    def card(self) -> Card:
        """The policy's card, which describes what it was trained for."""
        return self.policy.card


def beginning(named: Path) -> InitialPolicyOptions:
    """Read the policy of ``--from``, named as for `tltlc evaluate`; raises TltlError if it cannot be read."""
    path = policy_file(named)
    return InitialPolicyOptions(read_policy(path), path)


def own_place(named: Path, begun: InitialPolicyOptions) -> tuple[str, str]:
    """The level and the variant that a policy was trained on; raises TltlError if they are unknown."""
    path, name, variant = policy_place(named, None, _COMMAND)
    if name is None:
        check_known(begun.card.level, path, _COMMAND)
        name, variant = begun.card.level, begun.card.variant
    return name, variant or "v0"


def as_its_policy(settings: TrainingSettings, begun: InitialPolicyOptions, config: Path | None) -> TrainingSettings:
    """Return the settings with the policy's network.

    Raises:
        TltlError: TLT0941, the file ``config`` sets another network.
        UsageError: the settings are for imitation.
    """
    if settings.imitates:
        message = "--from is for the method `automaton`: an agent that imitates begins with what it is shown"
        raise click.UsageError(message, click.get_current_context())
    network = begun.card.network
    asked = {} if config is None else read_values(fileio.read_source(config)).get("network", {})
    if replace(network, **asked) != network:
        title = f"`{begun.path}` has another network than `[network]` in `{config}` asks for"
        raise TltlError([Diagnostic("TLT0941", title, help=f"leave `[network]` out of `{config}`, or --from")])
    return replace(settings, network=network)


def check_beginning(begun: InitialPolicyOptions, level: Level, fspa: Fspa, asked: Mapping[str, Any]) -> Sensors:
    """Check the initial policy and return its sensors, which the agent uses.  ``asked`` are the sensor options.

    Raises:
        TltlError: TLT0843, the policy does not fit the level or the spec; TLT0941, the options ask for
            other sensors.
    """
    check_policy(begun.card, level, fspa)
    titles = list(_other_senses(begun, level, asked))
    if titles:
        help_ = "leave the option out, or train without --from"
        raise TltlError([Diagnostic("TLT0941", title, help=help_) for title in titles])
    return begun.card.sensors


def is_another(run: TrainingRun, named: Path) -> str | None:
    """A sentence if a training did not start with this policy; None if it did."""
    where = f"the training in `{run.folder}` begins with"
    if run.initial is None:
        return f"{where} weights that are drawn, not with the policy `{named}`"
    same = weights_hash(read_policy(policy_file(named))) == run.initial.weights
    return None if same else f"{where} another policy than `{named}`"


def moved(run: TrainingRun, named: Path) -> TrainingRun:
    """Update the path of the initial policy."""
    assert run.initial is not None
    return replace(run, initial=replace(run.initial, path=str(policy_file(named))))


def _other_senses(begun: InitialPolicyOptions, level: Level, asked: Mapping[str, Any]) -> Iterator[str]:
    own, sensors = begun.card.sensors, chosen(level, asked) if asked else begun.card.sensors
    for key in asked:
        if getattr(sensors, key) != getattr(own, key):
            yield f"`{begun.path}` senses as `{option_of(key, own)}` says, not as `{option_of(key, sensors)}`"
