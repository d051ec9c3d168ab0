"""A player on a row of places that speaks the protocol of ML-Agents, as a Unity game does.

It uses the messages of the package mlagents-envs 0.28.0, whose descriptors are repeated here (names, numbers and types
of the fields), with the library protobuf and not with the code of tltlc. How the game behaves is that of
``com.unity.ml-agents`` (``RpcCommunicator.cs``), as ``rpc_communicator.py`` of the package expects it:

- the first call of ``Exchange`` has ``rl_initialization_output`` with the versions, the second one has no output;
- the answer to a command has ``agentInfos``; the first one that has an agent, and only that one, has
  ``brain_parameters``;
- at the end of an episode, the agent is in the list twice: ``done`` with the last observation, and with the first
  one of the next episode. RESET ends the episode, too.

Usage: python ml_agents_player.py --mlagents-port N [--host=HOST] [--lazy] [--agents=2] [--behaviors=2] [--fault=WORD]
       [--start=N]
"""

from __future__ import annotations

import struct
import sys
import threading
import uuid
from typing import Any

import grpc
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory

PORT = sys.argv[sys.argv.index("--mlagents-port") + 1] if "--mlagents-port" in sys.argv else "5004"
OPTIONS = dict(word.lstrip("-").partition("=")[::2] for word in sys.argv[1:])
FAULT = OPTIONS.get("fault", "")
PARAMETERS = uuid.UUID("534c891e-810f-11ea-a9d0-822485860400")
STEP, RESET, QUIT = 0, 1, 2
MESSAGES = {
    "HeaderProto": "status 1 int32, message 2 string",
    "UnityMessageProto": "header 1 HeaderProto, unity_output 2 UnityOutputProto, unity_input 3 UnityInputProto",
    "UnityOutputProto": "rl_output 1 UnityRLOutputProto, rl_initialization_output 2 UnityRLInitializationOutputProto",
    "UnityInputProto": "rl_input 1 UnityRLInputProto, rl_initialization_input 2 UnityRLInitializationInputProto",
    "UnityRLInputProto": "agent_actions 1 *ActionsEntry, command 4 int32, side_channel 5 bytes",
    "ActionsEntry": "key 1 string, value 2 ListAgentActionProto",
    "ListAgentActionProto": "value 1 *AgentActionProto",
    "AgentActionProto": "continuous_actions 6 *float, discrete_actions 7 *int32",
    "UnityRLOutputProto": "agentInfos 2 *InfosEntry, side_channel 3 bytes",
    "InfosEntry": "key 1 string, value 2 ListAgentInfoProto",
    "ListAgentInfoProto": "value 1 *AgentInfoProto",
    "AgentInfoProto": "reward 7 float, done 8 bool, max_step_reached 9 bool, id 10 int32, action_mask 11 *bool, "
    "observations 13 *ObservationProto, group_id 14 int32",
    "ObservationProto": "shape 1 *int32, compression_type 2 int32, compressed_data 3 bytes, float_data 4 FloatData, "
    "dimension_properties 6 *int32, observation_type 7 int32, name 8 string",
    "FloatData": "data 1 *float",
    "UnityRLInitializationInputProto": "seed 1 int32, communication_version 2 string, package_version 3 string, "
    "capabilities 4 UnityRLCapabilitiesProto, num_areas 5 int32",
    "UnityRLInitializationOutputProto": "name 1 string, communication_version 2 string, log_path 3 string, "
    "brain_parameters 5 *BrainParametersProto, package_version 7 string, capabilities 8 UnityRLCapabilitiesProto",
    "UnityRLCapabilitiesProto": "baseRLCapabilities 1 bool, hybridActions 4 bool, variableLengthObservation 6 bool",
    "BrainParametersProto": "brain_name 7 string, is_training 8 bool, action_spec 9 ActionSpecProto",
    "ActionSpecProto": "num_continuous_actions 1 int32, num_discrete_actions 2 int32, discrete_branch_sizes 3 *int32",
}
"""The fields of each message: name, number and type; ``*`` stands for `repeated`. Enums are written as int32."""


def message_classes() -> dict[str, Any]:
    types = {"string": 9, "int32": 5, "bool": 8, "bytes": 12, "float": 2}
    file = descriptor_pb2.FileDescriptorProto(name="ml_agents.proto", package="ml", syntax="proto3")
    for name, text in MESSAGES.items():
        message = file.message_type.add(name=name)
        for part in text.split(", "):
            field, number, type_ = part.split()
            word = type_.lstrip("*")
            added = message.field.add(
                name=field, number=int(number), type=types.get(word, 11), label=3 if "*" in type_ else 1
            )
            if word not in types:
                added.type_name = f".ml.{word}"
    pool = descriptor_pool.DescriptorPool()
    pool.Add(file) if hasattr(pool, "Add") else pool.AddSerializedFile(file.SerializeToString())
    return {name: message_factory.GetMessageClass(pool.FindMessageTypeByName(f"ml.{name}")) for name in MESSAGES}


CLASSES = message_classes()


class Game:
    """The player begins at the place 1 + seed mod 2, and the episode ends at the last place."""

    def __init__(self, exchange: Any) -> None:
        self.exchange = exchange
        self.length, self.place, self.ticks, self.seed = 5, 0, 0, 0
        self.is_known = self.has_begun = False

    def play(self) -> None:
        first = CLASSES["UnityMessageProto"]()
        first.header.status = 200
        start = first.unity_output.rl_initialization_output
        start.name, start.communication_version, start.package_version = "AcademySingleton", "1.5.0", "2.2.1"
        start.capabilities.baseRLCapabilities = start.capabilities.hybridActions = True
        if FAULT == "version":
            start.communication_version = "2.0.0"
        answer = self.exchange(first).unity_input.rl_initialization_input
        assert (answer.communication_version, answer.num_areas) == ("1.5.0", 1)
        assert answer.capabilities.hybridActions
        self.seed = int(OPTIONS.get("start", answer.seed % 2 + 1)) - 1
        empty = CLASSES["UnityMessageProto"]()
        empty.header.status = 200
        asked = self.exchange(empty).unity_input.rl_input
        while asked.command != QUIT:
            ended = self.has_begun
            if asked.command == RESET:
                self.configure(asked.side_channel)
                infos = self.begin(*([self.info(done=True, max_step_reached=True)] if ended else []))
            elif "lazy" in OPTIONS and self.ticks % 2 == 0 and self.has_begun and not asked.agent_actions:
                self.ticks += 1
                infos = [self.info()]
            else:
                infos = self.move(asked)
            asked = self.exchange(self.message(infos)).unity_input.rl_input

    def configure(self, data: bytes) -> None:
        scales = []
        while data:
            channel, length = uuid.UUID(bytes_le=data[:16]), struct.unpack_from("<i", data, 16)[0]
            content, data = data[20 : 20 + length], data[20 + length :]
            if channel == PARAMETERS:
                size = struct.unpack_from("<i", content)[0]
                assert content[4 : 4 + size] == b"length"
                kind, value = struct.unpack_from("<if", content, 4 + size)
                assert kind == 0
                self.length = int(value)
            else:
                scales.append(struct.unpack_from("<i", content)[0])
        assert scales == [2, 3, 4]

    def begin(self, *before: Any) -> list[Any]:
        self.place, self.ticks, self.has_begun = 1 + self.seed, 0, True
        return [*before, self.info()]

    def move(self, asked: Any) -> list[Any]:
        (entry,) = asked.agent_actions
        assert entry.key == "Walker?team=0"
        (action,) = entry.value.value
        (move,) = action.discrete_actions
        assert len(action.continuous_actions) == 2
        if FAULT == "exit":
            print("NullReferenceException: the hero", file=sys.stderr, flush=True)
            sys.exit(3)
        self.ticks += 1
        self.place = max(self.place + move - 1, 0)
        if self.place >= self.length:
            return self.begin(self.info(done=True, reward=1.0))
        return [] if "lazy" in OPTIONS and self.ticks % 2 == 0 else [self.info()]

    def info(self, **fields: Any) -> Any:
        info = CLASSES["AgentInfoProto"](id=7, **fields)
        info.observations.add(shape=[2], name="VectorSensor_size2").float_data.data.extend([self.place, self.ticks])
        picture = info.observations.add(shape=[1, 2, 3], name="CameraSensor")
        if FAULT == "png":
            picture.compression_type, picture.compressed_data = 1, b"\x89PNG"
        else:
            picture.float_data.data.extend([0, 0, 0, 1, 1, 1])
        return info

    def message(self, infos: list[Any]) -> Any:
        message = CLASSES["UnityMessageProto"]()
        message.header.status = 200
        output = message.unity_output
        output.rl_output.side_channel = b""
        for number in range(int(OPTIONS.get("behaviors", "1"))):
            name = "Walker?team=0" if number == 0 else f"Guard_{number}?team=0"
            entry = output.rl_output.agentInfos.add(key=name)
            entry.value.value.extend(infos * int(OPTIONS.get("agents", "1")))
            if infos and not self.is_known:
                brain = output.rl_initialization_output.brain_parameters.add(brain_name=name, is_training=True)
                brain.action_spec.num_continuous_actions = 2
                brain.action_spec.num_discrete_actions = 1
                brain.action_spec.discrete_branch_sizes.append(3)
        self.is_known = self.is_known or bool(infos)
        return message


if __name__ == "__main__":
    if FAULT == "early":
        sys.exit("there is no display")
    if FAULT == "silent":
        threading.Event().wait()
    with grpc.insecure_channel(f"{OPTIONS.get('host', '127.0.0.1')}:{PORT}") as to_trainer:
        call = to_trainer.unary_unary(
            "/communicator_objects.UnityToExternalProto/Exchange",
            request_serializer=(lambda _: b"\xff\xff")
            if FAULT == "bytes"
            else lambda message: message.SerializeToString(),
            response_deserializer=CLASSES["UnityMessageProto"].FromString,
        )
        try:
            Game(lambda message: call(message, wait_for_ready=True)).play()
        except grpc.RpcError as error:
            sys.exit(f"the trainer has gone: {error.code()}")
