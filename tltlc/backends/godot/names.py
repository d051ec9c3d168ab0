"""Names of variables in GDScript: the reserved names, and the conversion to snake_case."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable
from typing import Final

from tltlc.program.names import VariableNames

_WORDS: Final = """
    if elif else for do while match switch case default break continue pass return class class_name extends is in as
    self super signal func function static const enum var onready export setget tool breakpoint preload await yield
    assert void trait namespace when get set not and or true false null remote sync master puppet slave remotesync
    mastersync puppetsync bool int float string inf nan pi tau abstract private public protected rpc
""".split()

_FUNCTIONS: Final = """
    sin cos tan sinh cosh tanh asin acos atan atan2 asinh acosh atanh sqrt fmod fposmod floor ceil round abs sign pow
    log exp is_nan is_inf is_finite is_equal_approx is_zero_approx ease decimals step_decimals stepify snapped lerp
    lerp_angle inverse_lerp range_lerp remap smoothstep move_toward dectime randomize randi randf rand_range
    randi_range randf_range randfn seed rand_seed deg2rad rad2deg deg_to_rad rad_to_deg linear2db db2linear
    linear_to_db db_to_linear polar2cartesian cartesian2polar wrapi wrapf wrap max min clamp nearest_po2 weakref
    funcref convert typeof type_exists type_string char ord str print printt prints printerr printraw print_debug
    print_rich print_verbose push_error push_warning var2str str2var var_to_str str_to_var var2bytes bytes2var
    var_to_bytes bytes_to_var range load inst2dict dict2inst inst_to_dict dict_to_inst validate_json parse_json
    to_json hash print_stack get_stack instance_from_id is_instance_id_valid is_instance_valid len is_same error_string
    absf absi ceilf ceili floorf floori roundf roundi signf signi maxf maxi minf mini clampf clampi lerpf posmod
    posmodv snappedf snappedi pingpong cubic_interpolate bezier_interpolate bezier_derivative rotate_toward
    angle_difference rid_allocate_id rid_from_int64 is_instance_of color8 rand_from_seed type_convert
    bytes_to_var_with_objects var_to_bytes_with_objects cubic_interpolate_angle cubic_interpolate_in_time
    cubic_interpolate_angle_in_time
""".split()

_OBJECT: Final = """
    free script add_user_signal call call_deferred callv can_translate_messages cancel_free connect disconnect
    emit_signal get_class get_class_name get_incoming_connections get_indexed get_instance_id get_meta get_meta_list
    get_method_list get_method_argument_count get_property_list get_script get_signal_connection_list get_signal_list
    has_connections has_meta has_method has_signal has_user_signal is_blocking_signals is_class is_connected
    is_queued_for_deletion notification notify_property_list_changed property_can_revert property_get_revert
    property_list_changed_notify remove_meta remove_user_signal set_block_signals set_deferred set_indexed
    set_message_translation set_meta set_script set_translation_domain get_translation_domain to_string tr tr_n
    script_changed property_list_changed init_ref reference unreference get_reference_count new
    get_signal_connection_list get_incoming_connections
""".split()

_OWN: Final = """
    sample clear given params values notices noticed which problem verdict accepting limiting limiting_atom label
    message step steps begin reset state progress done reward robustness reached ends best target
    state_shape label_of label_english label_english_of sparse failure failed_step failed_clause failed_atom
""".split()
"""Names of variables in the template that do not begin with ``_``.

Generated names do not begin with ``_``, so they cannot clash with the other names in the template.
"""

RESERVED: Final = frozenset((*_WORDS, *_FUNCTIONS, *_OBJECT, *_OWN))


def snake_case(names: Iterable[str], reserved: Collection[str] = RESERVED) -> dict[str, str]:
    """Map each name with a capital letter to a new, unique name in snake_case: ``nearDoor`` to ``near_door``.

    Names without a capital letter are left out, and no new name is ``reserved``. A variable with a
    capital letter could have the name of a class of the engine, such as ``Node``.
    """
    all_names = list(names)
    unique_names = VariableNames({*reserved, *all_names})
    return {name: unique_names.new_name(_lower(name)) for name in all_names if name != name.lower()}


def _lower(name: str) -> str:
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()
