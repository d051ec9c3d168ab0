"""The network of a policy: Gutiérrez-Sánchez et al., IEEE Trans. Games 2024, section V.

The inputs are the automaton state (one-hot), progress, entities, variables and the semantic map
after its convolutions. Two fully connected layers follow. Three points differ from the paper:
progress is an input; the map has a channel for each type, where the paper's cells hold a number;
and there are two convolutions instead of one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final, Literal, get_args

from tltlc.api import record

Shapes = Mapping[str, tuple[int, ...]]
"""The shapes of one environment's observation by key: (n,) or (channels, height, width)."""

Activation = Literal["elu", "selu", "relu", "lrelu", "tanh", "sigmoid", "softplus", "gelu", "swish", "mish"]

MAX_LAYERS: Final = 16
MAX_WIDTH: Final = 16_384
MAX_KERNEL: Final = 15
MAX_STRIDE: Final = 8


@record
class Network:
    """The layers of a network.

    Each map of an observation goes through its own convolutions; ``channels`` are their output
    channels. Fully connected layers follow; ``hidden`` are their widths. ``kernel`` and ``stride``,
    in cells, hold for all convolutions. ``activation`` is a name that rsl-rl knows.

    Raises:
        ValueError: the activation is unknown, or a number is out of range.
    """

    hidden: tuple[int, ...] = (512, 512)
    activation: Activation = "elu"
    channels: tuple[int, ...] = (16, 32)
    kernel: int = 3
    stride: int = 2

    def __post_init__(self) -> None:
        for name in ("hidden", "channels"):
            widths = getattr(self, name)
            if not (1 <= len(widths) <= MAX_LAYERS and all(1 <= width <= MAX_WIDTH for width in widths)):
                raise ValueError(
                    f"{name} must be 1 to {MAX_LAYERS} layers, each 1 to {MAX_WIDTH} wide, not {widths!r:.60}"
                )
        for name, most in (("kernel", MAX_KERNEL), ("stride", MAX_STRIDE)):
            if not 1 <= getattr(self, name) <= most:
                raise ValueError(f"{name} must be from 1 to {most} cells, not {getattr(self, name)!r:.40}")
        if self.activation not in get_args(Activation):
            raise ValueError(
                f"activation must be one of {', '.join(get_args(Activation))}, not {self.activation!r:.40}"
            )


def model_config(network: Network, shapes: Shapes, branches: Sequence[int] | None = None) -> dict[str, Any]:
    """Return rsl-rl's configuration of an actor, or of a critic if ``branches`` is None.

    ``shapes`` are the shapes of the parts of an observation, by key. ``branches`` has the number of
    choices of each branch of an action.
    """
    config: dict[str, Any] = {
        "class_name": "MLPModel",
        "hidden_dims": list(network.hidden),
        "activation": network.activation,
    }
    if any(len(shape) == 3 for shape in shapes.values()):
        config |= {
            "class_name": "CNNModel",
            "cnn_cfg": {
                "output_channels": list(network.channels),
                "kernel_size": network.kernel,
                "stride": network.stride,
                "padding": "zeros",
                "activation": network.activation,
            },
        }
    if branches is not None:
        distribution = "tltl_runtime.policies.actions:MultiCategorical"
        config["distribution_cfg"] = {"class_name": distribution, "branches": tuple(branches)}
    return config
