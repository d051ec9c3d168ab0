"""Validates artefacts. Generated from fspa.schema.json by generate.py: do not edit."""
# ruff: noqa
# mypy: ignore-errors
# fmt: off
from tltlc.artefact.errors import JsonSchemaValueException
import re


REGEX_PATTERNS = {
    '^[A-Za-z_][A-Za-z0-9_]*$': re.compile('^[A-Za-z_][A-Za-z0-9_]*\\Z')
}

NoneType = type(None)

def validate(data: object, custom_formats: object = {}, name_prefix: object = None) -> object:
    if not isinstance(data, (dict)):
        raise JsonSchemaValueException("" + (name_prefix or "data") + " must be object", "" + (name_prefix or "data") + "", 'type')
    data_is_dict = isinstance(data, dict)
    if data_is_dict:
        data__missing_keys = set(['format', 'version', 'spec', 'semantics', 'signals', 'params', 'atoms', 'exclusive', 'states', 'initial', 'edges', 'spec_size']) - data.keys()
        if data__missing_keys:
            raise JsonSchemaValueException("" + (name_prefix or "data") + " must contain " + (str(sorted(data__missing_keys)) + " properties"), "" + (name_prefix or "data") + "", 'required')
        if "acceptance" in data:
            data_is_dict = isinstance(data, dict)
            if data_is_dict:
                data_keys = set(data.keys())
                if "semantics" in data_keys:
                    data_keys.remove("semantics")
                    data__semantics = data["semantics"]
                    if not (isinstance(data__semantics, str) and data__semantics == 'infinite'):
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".semantics must be one of ['infinite']", "" + (name_prefix or "data") + ".semantics", 'enum')
        data_keys = set(data.keys())
        if "format" in data_keys:
            data_keys.remove("format")
            data__format = data["format"]
            if not (isinstance(data__format, str) and data__format == 'fspa'):
                raise JsonSchemaValueException("" + (name_prefix or "data") + ".format must be one of ['fspa']", "" + (name_prefix or "data") + ".format", 'enum')
        if "version" in data_keys:
            data_keys.remove("version")
            data__version = data["version"]
            if not (isinstance(data__version, (int, float)) and not isinstance(data__version, bool) and data__version == 1):
                raise JsonSchemaValueException("" + (name_prefix or "data") + ".version must be one of [1]", "" + (name_prefix or "data") + ".version", 'enum')
        if "spec" in data_keys:
            data_keys.remove("spec")
            data__spec = data["spec"]
            if not isinstance(data__spec, (dict)):
                raise JsonSchemaValueException("" + (name_prefix or "data") + ".spec must be object", "" + (name_prefix or "data") + ".spec", 'type')
            data__spec_is_dict = isinstance(data__spec, dict)
            if data__spec_is_dict:
                data__spec__missing_keys = set(['name', 'doc', 'formula', 'limit_steps', 'judge', 'level']) - data__spec.keys()
                if data__spec__missing_keys:
                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".spec must contain " + (str(sorted(data__spec__missing_keys)) + " properties"), "" + (name_prefix or "data") + ".spec", 'required')
                data__spec_keys = set(data__spec.keys())
                if "name" in data__spec_keys:
                    data__spec_keys.remove("name")
                    data__spec__name = data__spec["name"]
                    if not isinstance(data__spec__name, (str)):
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".spec.name must be string", "" + (name_prefix or "data") + ".spec.name", 'type')
                    if isinstance(data__spec__name, str):
                        if not REGEX_PATTERNS['^[A-Za-z_][A-Za-z0-9_]*$'].search(data__spec__name):
                            raise JsonSchemaValueException("" + (name_prefix or "data") + ".spec.name must match pattern ^[A-Za-z_][A-Za-z0-9_]*$", "" + (name_prefix or "data") + ".spec.name", 'pattern')
                if "doc" in data__spec_keys:
                    data__spec_keys.remove("doc")
                    data__spec__doc = data__spec["doc"]
                    if not isinstance(data__spec__doc, (str)):
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".spec.doc must be string", "" + (name_prefix or "data") + ".spec.doc", 'type')
                if "formula" in data__spec_keys:
                    data__spec_keys.remove("formula")
                    data__spec__formula = data__spec["formula"]
                    if not isinstance(data__spec__formula, (dict)):
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".spec.formula must be object", "" + (name_prefix or "data") + ".spec.formula", 'type')
                    data__spec__formula_is_dict = isinstance(data__spec__formula, dict)
                    if data__spec__formula_is_dict:
                        data__spec__formula__missing_keys = set(['ascii', 'unicode', 'english']) - data__spec__formula.keys()
                        if data__spec__formula__missing_keys:
                            raise JsonSchemaValueException("" + (name_prefix or "data") + ".spec.formula must contain " + (str(sorted(data__spec__formula__missing_keys)) + " properties"), "" + (name_prefix or "data") + ".spec.formula", 'required')
                        data__spec__formula_keys = set(data__spec__formula.keys())
                        if "ascii" in data__spec__formula_keys:
                            data__spec__formula_keys.remove("ascii")
                            data__spec__formula__ascii = data__spec__formula["ascii"]
                            if not isinstance(data__spec__formula__ascii, (str)):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".spec.formula.ascii must be string", "" + (name_prefix or "data") + ".spec.formula.ascii", 'type')
                        if "unicode" in data__spec__formula_keys:
                            data__spec__formula_keys.remove("unicode")
                            data__spec__formula__unicode = data__spec__formula["unicode"]
                            if not isinstance(data__spec__formula__unicode, (str)):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".spec.formula.unicode must be string", "" + (name_prefix or "data") + ".spec.formula.unicode", 'type')
                        if "english" in data__spec__formula_keys:
                            data__spec__formula_keys.remove("english")
                            data__spec__formula__english = data__spec__formula["english"]
                            if not isinstance(data__spec__formula__english, (str)):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".spec.formula.english must be string", "" + (name_prefix or "data") + ".spec.formula.english", 'type')
                if "limit_steps" in data__spec_keys:
                    data__spec_keys.remove("limit_steps")
                    data__spec__limitsteps = data__spec["limit_steps"]
                    if not isinstance(data__spec__limitsteps, (int, NoneType)) and not (isinstance(data__spec__limitsteps, float) and data__spec__limitsteps.is_integer()) or isinstance(data__spec__limitsteps, bool):
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".spec.limit_steps must be integer or null", "" + (name_prefix or "data") + ".spec.limit_steps", 'type')
                    if isinstance(data__spec__limitsteps, (int, float)) and not isinstance(data__spec__limitsteps, bool):
                        if data__spec__limitsteps < 1:
                            raise JsonSchemaValueException("" + (name_prefix or "data") + ".spec.limit_steps must be bigger than or equal to 1", "" + (name_prefix or "data") + ".spec.limit_steps", 'minimum')
                if "judge" in data__spec_keys:
                    data__spec_keys.remove("judge")
                    data__spec__judge = data__spec["judge"]
                    if not (isinstance(data__spec__judge, str) and data__spec__judge == 'goal' or isinstance(data__spec__judge, str) and data__spec__judge == 'limit'):
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".spec.judge must be one of ['goal', 'limit']", "" + (name_prefix or "data") + ".spec.judge", 'enum')
                if "level" in data__spec_keys:
                    data__spec_keys.remove("level")
                    data__spec__level = data__spec["level"]
                    if not isinstance(data__spec__level, (str, NoneType)):
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".spec.level must be string or null", "" + (name_prefix or "data") + ".spec.level", 'type')
                if "tags" in data__spec_keys:
                    data__spec_keys.remove("tags")
                    data__spec__tags = data__spec["tags"]
                    if not isinstance(data__spec__tags, (list, tuple)):
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".spec.tags must be array", "" + (name_prefix or "data") + ".spec.tags", 'type')
                    data__spec__tags_is_list = isinstance(data__spec__tags, (list, tuple))
                    if data__spec__tags_is_list:
                        data__spec__tags_len = len(data__spec__tags)
                        for data__spec__tags_x, data__spec__tags_item in enumerate(data__spec__tags):
                            if not isinstance(data__spec__tags_item, (str)):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".spec.tags[{data__spec__tags_x}]".format(**locals()) + " must be string", "" + (name_prefix or "data") + ".spec.tags[{data__spec__tags_x}]".format(**locals()) + "", 'type')
                if "clock_s" in data__spec_keys:
                    data__spec_keys.remove("clock_s")
                    data__spec__clocks = data__spec["clock_s"]
                    if not isinstance(data__spec__clocks, (int, float, NoneType)) or isinstance(data__spec__clocks, bool):
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".spec.clock_s must be number or null", "" + (name_prefix or "data") + ".spec.clock_s", 'type')
                    if isinstance(data__spec__clocks, (int, float)) and not isinstance(data__spec__clocks, bool):
                        if data__spec__clocks > 1e+300:
                            raise JsonSchemaValueException("" + (name_prefix or "data") + ".spec.clock_s must be smaller than or equal to 1e+300", "" + (name_prefix or "data") + ".spec.clock_s", 'maximum')
                        if data__spec__clocks <= 0:
                            raise JsonSchemaValueException("" + (name_prefix or "data") + ".spec.clock_s must be bigger than 0", "" + (name_prefix or "data") + ".spec.clock_s", 'exclusiveMinimum')
        if "semantics" in data_keys:
            data_keys.remove("semantics")
            data__semantics = data["semantics"]
            if not (isinstance(data__semantics, str) and data__semantics == 'finite' or isinstance(data__semantics, str) and data__semantics == 'infinite'):
                raise JsonSchemaValueException("" + (name_prefix or "data") + ".semantics must be one of ['finite', 'infinite']", "" + (name_prefix or "data") + ".semantics", 'enum')
        if "signals" in data_keys:
            data_keys.remove("signals")
            data__signals = data["signals"]
            if not isinstance(data__signals, (list, tuple)):
                raise JsonSchemaValueException("" + (name_prefix or "data") + ".signals must be array", "" + (name_prefix or "data") + ".signals", 'type')
            data__signals_is_list = isinstance(data__signals, (list, tuple))
            if data__signals_is_list:
                data__signals_len = len(data__signals)
                for data__signals_x, data__signals_item in enumerate(data__signals):
                    if not isinstance(data__signals_item, (dict)):
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".signals[{data__signals_x}]".format(**locals()) + " must be object", "" + (name_prefix or "data") + ".signals[{data__signals_x}]".format(**locals()) + "", 'type')
                    data__signals_item_is_dict = isinstance(data__signals_item, dict)
                    if data__signals_item_is_dict:
                        data__signals_item__missing_keys = set(['name', 'type', 'range']) - data__signals_item.keys()
                        if data__signals_item__missing_keys:
                            raise JsonSchemaValueException("" + (name_prefix or "data") + ".signals[{data__signals_x}]".format(**locals()) + " must contain " + (str(sorted(data__signals_item__missing_keys)) + " properties"), "" + (name_prefix or "data") + ".signals[{data__signals_x}]".format(**locals()) + "", 'required')
                        data__signals_item_keys = set(data__signals_item.keys())
                        if "name" in data__signals_item_keys:
                            data__signals_item_keys.remove("name")
                            data__signals_item__name = data__signals_item["name"]
                            if not isinstance(data__signals_item__name, (str)):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".signals[{data__signals_x}].name".format(**locals()) + " must be string", "" + (name_prefix or "data") + ".signals[{data__signals_x}].name".format(**locals()) + "", 'type')
                            if isinstance(data__signals_item__name, str):
                                data__signals_item__name_len = len(data__signals_item__name)
                                if data__signals_item__name_len < 1:
                                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".signals[{data__signals_x}].name".format(**locals()) + " must be longer than or equal to 1 characters", "" + (name_prefix or "data") + ".signals[{data__signals_x}].name".format(**locals()) + "", 'minLength')
                        if "type" in data__signals_item_keys:
                            data__signals_item_keys.remove("type")
                            data__signals_item__type = data__signals_item["type"]
                            if not (isinstance(data__signals_item__type, str) and data__signals_item__type == 'number' or isinstance(data__signals_item__type, str) and data__signals_item__type == 'ratio' or isinstance(data__signals_item__type, str) and data__signals_item__type == 'length' or isinstance(data__signals_item__type, str) and data__signals_item__type == 'time' or isinstance(data__signals_item__type, str) and data__signals_item__type == 'speed' or isinstance(data__signals_item__type, str) and data__signals_item__type == 'angle' or isinstance(data__signals_item__type, str) and data__signals_item__type == 'bool'):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".signals[{data__signals_x}].type".format(**locals()) + " must be one of ['number', 'ratio', 'length', 'time', 'speed', 'angle', 'bool']", "" + (name_prefix or "data") + ".signals[{data__signals_x}].type".format(**locals()) + "", 'enum')
                        if "range" in data__signals_item_keys:
                            data__signals_item_keys.remove("range")
                            data__signals_item__range = data__signals_item["range"]
                            if not isinstance(data__signals_item__range, (list, tuple)):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".signals[{data__signals_x}].range".format(**locals()) + " must be array", "" + (name_prefix or "data") + ".signals[{data__signals_x}].range".format(**locals()) + "", 'type')
                            data__signals_item__range_is_list = isinstance(data__signals_item__range, (list, tuple))
                            if data__signals_item__range_is_list:
                                data__signals_item__range_len = len(data__signals_item__range)
                                if data__signals_item__range_len < 2:
                                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".signals[{data__signals_x}].range".format(**locals()) + " must contain at least 2 items", "" + (name_prefix or "data") + ".signals[{data__signals_x}].range".format(**locals()) + "", 'minItems')
                                if data__signals_item__range_len > 2:
                                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".signals[{data__signals_x}].range".format(**locals()) + " must contain less than or equal to 2 items", "" + (name_prefix or "data") + ".signals[{data__signals_x}].range".format(**locals()) + "", 'maxItems')
                                for data__signals_item__range_x, data__signals_item__range_item in enumerate(data__signals_item__range):
                                    if not isinstance(data__signals_item__range_item, (int, float, NoneType)) or isinstance(data__signals_item__range_item, bool):
                                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".signals[{data__signals_x}].range[{data__signals_item__range_x}]".format(**locals()) + " must be number or null", "" + (name_prefix or "data") + ".signals[{data__signals_x}].range[{data__signals_item__range_x}]".format(**locals()) + "", 'type')
                                    if isinstance(data__signals_item__range_item, (int, float)) and not isinstance(data__signals_item__range_item, bool):
                                        if data__signals_item__range_item < -1.7976931348623157e+308:
                                            raise JsonSchemaValueException("" + (name_prefix or "data") + ".signals[{data__signals_x}].range[{data__signals_item__range_x}]".format(**locals()) + " must be bigger than or equal to -1.7976931348623157e+308", "" + (name_prefix or "data") + ".signals[{data__signals_x}].range[{data__signals_item__range_x}]".format(**locals()) + "", 'minimum')
                                        if data__signals_item__range_item > 1.7976931348623157e+308:
                                            raise JsonSchemaValueException("" + (name_prefix or "data") + ".signals[{data__signals_x}].range[{data__signals_item__range_x}]".format(**locals()) + " must be smaller than or equal to 1.7976931348623157e+308", "" + (name_prefix or "data") + ".signals[{data__signals_x}].range[{data__signals_item__range_x}]".format(**locals()) + "", 'maximum')
                        if "doc" in data__signals_item_keys:
                            data__signals_item_keys.remove("doc")
                            data__signals_item__doc = data__signals_item["doc"]
                            if not isinstance(data__signals_item__doc, (str)):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".signals[{data__signals_x}].doc".format(**locals()) + " must be string", "" + (name_prefix or "data") + ".signals[{data__signals_x}].doc".format(**locals()) + "", 'type')
        if "params" in data_keys:
            data_keys.remove("params")
            data__params = data["params"]
            if not isinstance(data__params, (list, tuple)):
                raise JsonSchemaValueException("" + (name_prefix or "data") + ".params must be array", "" + (name_prefix or "data") + ".params", 'type')
            data__params_is_list = isinstance(data__params, (list, tuple))
            if data__params_is_list:
                data__params_len = len(data__params)
                for data__params_x, data__params_item in enumerate(data__params):
                    if not isinstance(data__params_item, (dict)):
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".params[{data__params_x}]".format(**locals()) + " must be object", "" + (name_prefix or "data") + ".params[{data__params_x}]".format(**locals()) + "", 'type')
                    data__params_item_is_dict = isinstance(data__params_item, dict)
                    if data__params_item_is_dict:
                        data__params_item__missing_keys = set(['name', 'type', 'value']) - data__params_item.keys()
                        if data__params_item__missing_keys:
                            raise JsonSchemaValueException("" + (name_prefix or "data") + ".params[{data__params_x}]".format(**locals()) + " must contain " + (str(sorted(data__params_item__missing_keys)) + " properties"), "" + (name_prefix or "data") + ".params[{data__params_x}]".format(**locals()) + "", 'required')
                        data__params_item_keys = set(data__params_item.keys())
                        if "name" in data__params_item_keys:
                            data__params_item_keys.remove("name")
                            data__params_item__name = data__params_item["name"]
                            if not isinstance(data__params_item__name, (str)):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".params[{data__params_x}].name".format(**locals()) + " must be string", "" + (name_prefix or "data") + ".params[{data__params_x}].name".format(**locals()) + "", 'type')
                            if isinstance(data__params_item__name, str):
                                data__params_item__name_len = len(data__params_item__name)
                                if data__params_item__name_len < 1:
                                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".params[{data__params_x}].name".format(**locals()) + " must be longer than or equal to 1 characters", "" + (name_prefix or "data") + ".params[{data__params_x}].name".format(**locals()) + "", 'minLength')
                        if "type" in data__params_item_keys:
                            data__params_item_keys.remove("type")
                            data__params_item__type = data__params_item["type"]
                            if not (isinstance(data__params_item__type, str) and data__params_item__type == 'number' or isinstance(data__params_item__type, str) and data__params_item__type == 'ratio' or isinstance(data__params_item__type, str) and data__params_item__type == 'length' or isinstance(data__params_item__type, str) and data__params_item__type == 'time' or isinstance(data__params_item__type, str) and data__params_item__type == 'speed' or isinstance(data__params_item__type, str) and data__params_item__type == 'angle' or isinstance(data__params_item__type, str) and data__params_item__type == 'bool'):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".params[{data__params_x}].type".format(**locals()) + " must be one of ['number', 'ratio', 'length', 'time', 'speed', 'angle', 'bool']", "" + (name_prefix or "data") + ".params[{data__params_x}].type".format(**locals()) + "", 'enum')
                        if "value" in data__params_item_keys:
                            data__params_item_keys.remove("value")
                            data__params_item__value = data__params_item["value"]
                            if not isinstance(data__params_item__value, (int, float)) or isinstance(data__params_item__value, bool):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".params[{data__params_x}].value".format(**locals()) + " must be number", "" + (name_prefix or "data") + ".params[{data__params_x}].value".format(**locals()) + "", 'type')
                            if isinstance(data__params_item__value, (int, float)) and not isinstance(data__params_item__value, bool):
                                if data__params_item__value < -1.7976931348623157e+308:
                                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".params[{data__params_x}].value".format(**locals()) + " must be bigger than or equal to -1.7976931348623157e+308", "" + (name_prefix or "data") + ".params[{data__params_x}].value".format(**locals()) + "", 'minimum')
                                if data__params_item__value > 1.7976931348623157e+308:
                                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".params[{data__params_x}].value".format(**locals()) + " must be smaller than or equal to 1.7976931348623157e+308", "" + (name_prefix or "data") + ".params[{data__params_x}].value".format(**locals()) + "", 'maximum')
                        if "range" in data__params_item_keys:
                            data__params_item_keys.remove("range")
                            data__params_item__range = data__params_item["range"]
                            if not isinstance(data__params_item__range, (list, tuple)):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".params[{data__params_x}].range".format(**locals()) + " must be array", "" + (name_prefix or "data") + ".params[{data__params_x}].range".format(**locals()) + "", 'type')
                            data__params_item__range_is_list = isinstance(data__params_item__range, (list, tuple))
                            if data__params_item__range_is_list:
                                data__params_item__range_len = len(data__params_item__range)
                                if data__params_item__range_len < 2:
                                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".params[{data__params_x}].range".format(**locals()) + " must contain at least 2 items", "" + (name_prefix or "data") + ".params[{data__params_x}].range".format(**locals()) + "", 'minItems')
                                if data__params_item__range_len > 2:
                                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".params[{data__params_x}].range".format(**locals()) + " must contain less than or equal to 2 items", "" + (name_prefix or "data") + ".params[{data__params_x}].range".format(**locals()) + "", 'maxItems')
                                for data__params_item__range_x, data__params_item__range_item in enumerate(data__params_item__range):
                                    if not isinstance(data__params_item__range_item, (int, float, NoneType)) or isinstance(data__params_item__range_item, bool):
                                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".params[{data__params_x}].range[{data__params_item__range_x}]".format(**locals()) + " must be number or null", "" + (name_prefix or "data") + ".params[{data__params_x}].range[{data__params_item__range_x}]".format(**locals()) + "", 'type')
                                    if isinstance(data__params_item__range_item, (int, float)) and not isinstance(data__params_item__range_item, bool):
                                        if data__params_item__range_item < -1.7976931348623157e+308:
                                            raise JsonSchemaValueException("" + (name_prefix or "data") + ".params[{data__params_x}].range[{data__params_item__range_x}]".format(**locals()) + " must be bigger than or equal to -1.7976931348623157e+308", "" + (name_prefix or "data") + ".params[{data__params_x}].range[{data__params_item__range_x}]".format(**locals()) + "", 'minimum')
                                        if data__params_item__range_item > 1.7976931348623157e+308:
                                            raise JsonSchemaValueException("" + (name_prefix or "data") + ".params[{data__params_x}].range[{data__params_item__range_x}]".format(**locals()) + " must be smaller than or equal to 1.7976931348623157e+308", "" + (name_prefix or "data") + ".params[{data__params_x}].range[{data__params_item__range_x}]".format(**locals()) + "", 'maximum')
                        if "doc" in data__params_item_keys:
                            data__params_item_keys.remove("doc")
                            data__params_item__doc = data__params_item["doc"]
                            if not isinstance(data__params_item__doc, (str)):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".params[{data__params_x}].doc".format(**locals()) + " must be string", "" + (name_prefix or "data") + ".params[{data__params_x}].doc".format(**locals()) + "", 'type')
        if "atoms" in data_keys:
            data_keys.remove("atoms")
            data__atoms = data["atoms"]
            if not isinstance(data__atoms, (list, tuple)):
                raise JsonSchemaValueException("" + (name_prefix or "data") + ".atoms must be array", "" + (name_prefix or "data") + ".atoms", 'type')
            data__atoms_is_list = isinstance(data__atoms, (list, tuple))
            if data__atoms_is_list:
                data__atoms_len = len(data__atoms)
                for data__atoms_x, data__atoms_item in enumerate(data__atoms):
                    if not isinstance(data__atoms_item, (dict)):
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".atoms[{data__atoms_x}]".format(**locals()) + " must be object", "" + (name_prefix or "data") + ".atoms[{data__atoms_x}]".format(**locals()) + "", 'type')
                    data__atoms_item_is_dict = isinstance(data__atoms_item, dict)
                    if data__atoms_item_is_dict:
                        data__atoms_item__missing_keys = set(['name', 'expression']) - data__atoms_item.keys()
                        if data__atoms_item__missing_keys:
                            raise JsonSchemaValueException("" + (name_prefix or "data") + ".atoms[{data__atoms_x}]".format(**locals()) + " must contain " + (str(sorted(data__atoms_item__missing_keys)) + " properties"), "" + (name_prefix or "data") + ".atoms[{data__atoms_x}]".format(**locals()) + "", 'required')
                        data__atoms_item_keys = set(data__atoms_item.keys())
                        if "name" in data__atoms_item_keys:
                            data__atoms_item_keys.remove("name")
                            data__atoms_item__name = data__atoms_item["name"]
                            if not isinstance(data__atoms_item__name, (str)):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".atoms[{data__atoms_x}].name".format(**locals()) + " must be string", "" + (name_prefix or "data") + ".atoms[{data__atoms_x}].name".format(**locals()) + "", 'type')
                            if isinstance(data__atoms_item__name, str):
                                data__atoms_item__name_len = len(data__atoms_item__name)
                                if data__atoms_item__name_len < 1:
                                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".atoms[{data__atoms_x}].name".format(**locals()) + " must be longer than or equal to 1 characters", "" + (name_prefix or "data") + ".atoms[{data__atoms_x}].name".format(**locals()) + "", 'minLength')
                        if "expression" in data__atoms_item_keys:
                            data__atoms_item_keys.remove("expression")
                            data__atoms_item__expression = data__atoms_item["expression"]
                            validate___definitions_expression(data__atoms_item__expression, custom_formats, (name_prefix or "data") + ".atoms[{data__atoms_x}].expression".format(**locals()))
                        if "doc" in data__atoms_item_keys:
                            data__atoms_item_keys.remove("doc")
                            data__atoms_item__doc = data__atoms_item["doc"]
                            if not isinstance(data__atoms_item__doc, (str)):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".atoms[{data__atoms_x}].doc".format(**locals()) + " must be string", "" + (name_prefix or "data") + ".atoms[{data__atoms_x}].doc".format(**locals()) + "", 'type')
        if "exclusive" in data_keys:
            data_keys.remove("exclusive")
            data__exclusive = data["exclusive"]
            if not isinstance(data__exclusive, (list, tuple)):
                raise JsonSchemaValueException("" + (name_prefix or "data") + ".exclusive must be array", "" + (name_prefix or "data") + ".exclusive", 'type')
            data__exclusive_is_list = isinstance(data__exclusive, (list, tuple))
            if data__exclusive_is_list:
                data__exclusive_len = len(data__exclusive)
                for data__exclusive_x, data__exclusive_item in enumerate(data__exclusive):
                    if not isinstance(data__exclusive_item, (list, tuple)):
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".exclusive[{data__exclusive_x}]".format(**locals()) + " must be array", "" + (name_prefix or "data") + ".exclusive[{data__exclusive_x}]".format(**locals()) + "", 'type')
                    data__exclusive_item_is_list = isinstance(data__exclusive_item, (list, tuple))
                    if data__exclusive_item_is_list:
                        data__exclusive_item_len = len(data__exclusive_item)
                        if data__exclusive_item_len < 2:
                            raise JsonSchemaValueException("" + (name_prefix or "data") + ".exclusive[{data__exclusive_x}]".format(**locals()) + " must contain at least 2 items", "" + (name_prefix or "data") + ".exclusive[{data__exclusive_x}]".format(**locals()) + "", 'minItems')
                        def fn(var): return frozenset(dict((k, fn(v)) for k, v in var.items()).items()) if hasattr(var, "items") else tuple(fn(v) for v in var) if isinstance(var, (dict, list)) else (bool, var) if isinstance(var, bool) else var
                        if data__exclusive_item_len > len(set(fn(data__exclusive_item_x) for data__exclusive_item_x in data__exclusive_item)):
                            raise JsonSchemaValueException("" + (name_prefix or "data") + ".exclusive[{data__exclusive_x}]".format(**locals()) + " must contain unique items", "" + (name_prefix or "data") + ".exclusive[{data__exclusive_x}]".format(**locals()) + "", 'uniqueItems')
                        for data__exclusive_item_x, data__exclusive_item_item in enumerate(data__exclusive_item):
                            if not isinstance(data__exclusive_item_item, (int)) and not (isinstance(data__exclusive_item_item, float) and data__exclusive_item_item.is_integer()) or isinstance(data__exclusive_item_item, bool):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".exclusive[{data__exclusive_x}][{data__exclusive_item_x}]".format(**locals()) + " must be integer", "" + (name_prefix or "data") + ".exclusive[{data__exclusive_x}][{data__exclusive_item_x}]".format(**locals()) + "", 'type')
                            if isinstance(data__exclusive_item_item, (int, float)) and not isinstance(data__exclusive_item_item, bool):
                                if data__exclusive_item_item < 0:
                                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".exclusive[{data__exclusive_x}][{data__exclusive_item_x}]".format(**locals()) + " must be bigger than or equal to 0", "" + (name_prefix or "data") + ".exclusive[{data__exclusive_x}][{data__exclusive_item_x}]".format(**locals()) + "", 'minimum')
        if "states" in data_keys:
            data_keys.remove("states")
            data__states = data["states"]
            if not isinstance(data__states, (list, tuple)):
                raise JsonSchemaValueException("" + (name_prefix or "data") + ".states must be array", "" + (name_prefix or "data") + ".states", 'type')
            data__states_is_list = isinstance(data__states, (list, tuple))
            if data__states_is_list:
                data__states_len = len(data__states)
                if data__states_len < 1:
                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".states must contain at least 1 items", "" + (name_prefix or "data") + ".states", 'minItems')
                for data__states_x, data__states_item in enumerate(data__states):
                    if not isinstance(data__states_item, (dict)):
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".states[{data__states_x}]".format(**locals()) + " must be object", "" + (name_prefix or "data") + ".states[{data__states_x}]".format(**locals()) + "", 'type')
                    data__states_item_is_dict = isinstance(data__states_item, dict)
                    if data__states_item_is_dict:
                        data__states_item__missing_keys = set(['id', 'label', 'accepting', 'verdict', 'distance']) - data__states_item.keys()
                        if data__states_item__missing_keys:
                            raise JsonSchemaValueException("" + (name_prefix or "data") + ".states[{data__states_x}]".format(**locals()) + " must contain " + (str(sorted(data__states_item__missing_keys)) + " properties"), "" + (name_prefix or "data") + ".states[{data__states_x}]".format(**locals()) + "", 'required')
                        data__states_item_keys = set(data__states_item.keys())
                        if "id" in data__states_item_keys:
                            data__states_item_keys.remove("id")
                            data__states_item__id = data__states_item["id"]
                            if not isinstance(data__states_item__id, (int)) and not (isinstance(data__states_item__id, float) and data__states_item__id.is_integer()) or isinstance(data__states_item__id, bool):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".states[{data__states_x}].id".format(**locals()) + " must be integer", "" + (name_prefix or "data") + ".states[{data__states_x}].id".format(**locals()) + "", 'type')
                            if isinstance(data__states_item__id, (int, float)) and not isinstance(data__states_item__id, bool):
                                if data__states_item__id < 0:
                                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".states[{data__states_x}].id".format(**locals()) + " must be bigger than or equal to 0", "" + (name_prefix or "data") + ".states[{data__states_x}].id".format(**locals()) + "", 'minimum')
                        if "label" in data__states_item_keys:
                            data__states_item_keys.remove("label")
                            data__states_item__label = data__states_item["label"]
                            if not isinstance(data__states_item__label, (dict)):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".states[{data__states_x}].label".format(**locals()) + " must be object", "" + (name_prefix or "data") + ".states[{data__states_x}].label".format(**locals()) + "", 'type')
                            data__states_item__label_is_dict = isinstance(data__states_item__label, dict)
                            if data__states_item__label_is_dict:
                                data__states_item__label__missing_keys = set(['ascii', 'unicode', 'english']) - data__states_item__label.keys()
                                if data__states_item__label__missing_keys:
                                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".states[{data__states_x}].label".format(**locals()) + " must contain " + (str(sorted(data__states_item__label__missing_keys)) + " properties"), "" + (name_prefix or "data") + ".states[{data__states_x}].label".format(**locals()) + "", 'required')
                                data__states_item__label_keys = set(data__states_item__label.keys())
                                if "ascii" in data__states_item__label_keys:
                                    data__states_item__label_keys.remove("ascii")
                                    data__states_item__label__ascii = data__states_item__label["ascii"]
                                    if not isinstance(data__states_item__label__ascii, (str)):
                                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".states[{data__states_x}].label.ascii".format(**locals()) + " must be string", "" + (name_prefix or "data") + ".states[{data__states_x}].label.ascii".format(**locals()) + "", 'type')
                                if "unicode" in data__states_item__label_keys:
                                    data__states_item__label_keys.remove("unicode")
                                    data__states_item__label__unicode = data__states_item__label["unicode"]
                                    if not isinstance(data__states_item__label__unicode, (str)):
                                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".states[{data__states_x}].label.unicode".format(**locals()) + " must be string", "" + (name_prefix or "data") + ".states[{data__states_x}].label.unicode".format(**locals()) + "", 'type')
                                if "english" in data__states_item__label_keys:
                                    data__states_item__label_keys.remove("english")
                                    data__states_item__label__english = data__states_item__label["english"]
                                    if not isinstance(data__states_item__label__english, (str)):
                                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".states[{data__states_x}].label.english".format(**locals()) + " must be string", "" + (name_prefix or "data") + ".states[{data__states_x}].label.english".format(**locals()) + "", 'type')
                        if "accepting" in data__states_item_keys:
                            data__states_item_keys.remove("accepting")
                            data__states_item__accepting = data__states_item["accepting"]
                            if not isinstance(data__states_item__accepting, (bool)):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".states[{data__states_x}].accepting".format(**locals()) + " must be boolean", "" + (name_prefix or "data") + ".states[{data__states_x}].accepting".format(**locals()) + "", 'type')
                        if "verdict" in data__states_item_keys:
                            data__states_item_keys.remove("verdict")
                            data__states_item__verdict = data__states_item["verdict"]
                            if not (isinstance(data__states_item__verdict, str) and data__states_item__verdict == 'satisfied' or isinstance(data__states_item__verdict, str) and data__states_item__verdict == 'holding' or isinstance(data__states_item__verdict, str) and data__states_item__verdict == 'pending' or isinstance(data__states_item__verdict, str) and data__states_item__verdict == 'violated'):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".states[{data__states_x}].verdict".format(**locals()) + " must be one of ['satisfied', 'holding', 'pending', 'violated']", "" + (name_prefix or "data") + ".states[{data__states_x}].verdict".format(**locals()) + "", 'enum')
                        if "distance" in data__states_item_keys:
                            data__states_item_keys.remove("distance")
                            data__states_item__distance = data__states_item["distance"]
                            if not isinstance(data__states_item__distance, (int, NoneType)) and not (isinstance(data__states_item__distance, float) and data__states_item__distance.is_integer()) or isinstance(data__states_item__distance, bool):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".states[{data__states_x}].distance".format(**locals()) + " must be integer or null", "" + (name_prefix or "data") + ".states[{data__states_x}].distance".format(**locals()) + "", 'type')
                            if isinstance(data__states_item__distance, (int, float)) and not isinstance(data__states_item__distance, bool):
                                if data__states_item__distance < 0:
                                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".states[{data__states_x}].distance".format(**locals()) + " must be bigger than or equal to 0", "" + (name_prefix or "data") + ".states[{data__states_x}].distance".format(**locals()) + "", 'minimum')
        if "initial" in data_keys:
            data_keys.remove("initial")
            data__initial = data["initial"]
            if not (isinstance(data__initial, (int, float)) and not isinstance(data__initial, bool) and data__initial == 0):
                raise JsonSchemaValueException("" + (name_prefix or "data") + ".initial must be one of [0]", "" + (name_prefix or "data") + ".initial", 'enum')
        if "edges" in data_keys:
            data_keys.remove("edges")
            data__edges = data["edges"]
            if not isinstance(data__edges, (list, tuple)):
                raise JsonSchemaValueException("" + (name_prefix or "data") + ".edges must be array", "" + (name_prefix or "data") + ".edges", 'type')
            data__edges_is_list = isinstance(data__edges, (list, tuple))
            if data__edges_is_list:
                data__edges_len = len(data__edges)
                for data__edges_x, data__edges_item in enumerate(data__edges):
                    if not isinstance(data__edges_item, (dict)):
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".edges[{data__edges_x}]".format(**locals()) + " must be object", "" + (name_prefix or "data") + ".edges[{data__edges_x}]".format(**locals()) + "", 'type')
                    data__edges_item_is_dict = isinstance(data__edges_item, dict)
                    if data__edges_item_is_dict:
                        data__edges_item__missing_keys = set(['source', 'target', 'guard']) - data__edges_item.keys()
                        if data__edges_item__missing_keys:
                            raise JsonSchemaValueException("" + (name_prefix or "data") + ".edges[{data__edges_x}]".format(**locals()) + " must contain " + (str(sorted(data__edges_item__missing_keys)) + " properties"), "" + (name_prefix or "data") + ".edges[{data__edges_x}]".format(**locals()) + "", 'required')
                        data__edges_item_keys = set(data__edges_item.keys())
                        if "source" in data__edges_item_keys:
                            data__edges_item_keys.remove("source")
                            data__edges_item__source = data__edges_item["source"]
                            if not isinstance(data__edges_item__source, (int)) and not (isinstance(data__edges_item__source, float) and data__edges_item__source.is_integer()) or isinstance(data__edges_item__source, bool):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".edges[{data__edges_x}].source".format(**locals()) + " must be integer", "" + (name_prefix or "data") + ".edges[{data__edges_x}].source".format(**locals()) + "", 'type')
                            if isinstance(data__edges_item__source, (int, float)) and not isinstance(data__edges_item__source, bool):
                                if data__edges_item__source < 0:
                                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".edges[{data__edges_x}].source".format(**locals()) + " must be bigger than or equal to 0", "" + (name_prefix or "data") + ".edges[{data__edges_x}].source".format(**locals()) + "", 'minimum')
                        if "target" in data__edges_item_keys:
                            data__edges_item_keys.remove("target")
                            data__edges_item__target = data__edges_item["target"]
                            if not isinstance(data__edges_item__target, (int)) and not (isinstance(data__edges_item__target, float) and data__edges_item__target.is_integer()) or isinstance(data__edges_item__target, bool):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".edges[{data__edges_x}].target".format(**locals()) + " must be integer", "" + (name_prefix or "data") + ".edges[{data__edges_x}].target".format(**locals()) + "", 'type')
                            if isinstance(data__edges_item__target, (int, float)) and not isinstance(data__edges_item__target, bool):
                                if data__edges_item__target < 0:
                                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".edges[{data__edges_x}].target".format(**locals()) + " must be bigger than or equal to 0", "" + (name_prefix or "data") + ".edges[{data__edges_x}].target".format(**locals()) + "", 'minimum')
                        if "guard" in data__edges_item_keys:
                            data__edges_item_keys.remove("guard")
                            data__edges_item__guard = data__edges_item["guard"]
                            if not isinstance(data__edges_item__guard, (dict)):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".edges[{data__edges_x}].guard".format(**locals()) + " must be object", "" + (name_prefix or "data") + ".edges[{data__edges_x}].guard".format(**locals()) + "", 'type')
                            data__edges_item__guard_is_dict = isinstance(data__edges_item__guard, dict)
                            if data__edges_item__guard_is_dict:
                                data__edges_item__guard__missing_keys = set(['text', 'primes']) - data__edges_item__guard.keys()
                                if data__edges_item__guard__missing_keys:
                                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".edges[{data__edges_x}].guard".format(**locals()) + " must contain " + (str(sorted(data__edges_item__guard__missing_keys)) + " properties"), "" + (name_prefix or "data") + ".edges[{data__edges_x}].guard".format(**locals()) + "", 'required')
                                data__edges_item__guard_keys = set(data__edges_item__guard.keys())
                                if "text" in data__edges_item__guard_keys:
                                    data__edges_item__guard_keys.remove("text")
                                    data__edges_item__guard__text = data__edges_item__guard["text"]
                                    if not isinstance(data__edges_item__guard__text, (str)):
                                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".edges[{data__edges_x}].guard.text".format(**locals()) + " must be string", "" + (name_prefix or "data") + ".edges[{data__edges_x}].guard.text".format(**locals()) + "", 'type')
                                if "primes" in data__edges_item__guard_keys:
                                    data__edges_item__guard_keys.remove("primes")
                                    data__edges_item__guard__primes = data__edges_item__guard["primes"]
                                    if not isinstance(data__edges_item__guard__primes, (list, tuple)):
                                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".edges[{data__edges_x}].guard.primes".format(**locals()) + " must be array", "" + (name_prefix or "data") + ".edges[{data__edges_x}].guard.primes".format(**locals()) + "", 'type')
                                    data__edges_item__guard__primes_is_list = isinstance(data__edges_item__guard__primes, (list, tuple))
                                    if data__edges_item__guard__primes_is_list:
                                        data__edges_item__guard__primes_len = len(data__edges_item__guard__primes)
                                        if data__edges_item__guard__primes_len < 1:
                                            raise JsonSchemaValueException("" + (name_prefix or "data") + ".edges[{data__edges_x}].guard.primes".format(**locals()) + " must contain at least 1 items", "" + (name_prefix or "data") + ".edges[{data__edges_x}].guard.primes".format(**locals()) + "", 'minItems')
                                        for data__edges_item__guard__primes_x, data__edges_item__guard__primes_item in enumerate(data__edges_item__guard__primes):
                                            if not isinstance(data__edges_item__guard__primes_item, (list, tuple)):
                                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".edges[{data__edges_x}].guard.primes[{data__edges_item__guard__primes_x}]".format(**locals()) + " must be array", "" + (name_prefix or "data") + ".edges[{data__edges_x}].guard.primes[{data__edges_item__guard__primes_x}]".format(**locals()) + "", 'type')
                                            data__edges_item__guard__primes_item_is_list = isinstance(data__edges_item__guard__primes_item, (list, tuple))
                                            if data__edges_item__guard__primes_item_is_list:
                                                data__edges_item__guard__primes_item_len = len(data__edges_item__guard__primes_item)
                                                for data__edges_item__guard__primes_item_x, data__edges_item__guard__primes_item_item in enumerate(data__edges_item__guard__primes_item):
                                                    if not isinstance(data__edges_item__guard__primes_item_item, (list, tuple)):
                                                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".edges[{data__edges_x}].guard.primes[{data__edges_item__guard__primes_x}][{data__edges_item__guard__primes_item_x}]".format(**locals()) + " must be array", "" + (name_prefix or "data") + ".edges[{data__edges_x}].guard.primes[{data__edges_item__guard__primes_x}][{data__edges_item__guard__primes_item_x}]".format(**locals()) + "", 'type')
                                                    data__edges_item__guard__primes_item_item_is_list = isinstance(data__edges_item__guard__primes_item_item, (list, tuple))
                                                    if data__edges_item__guard__primes_item_item_is_list:
                                                        data__edges_item__guard__primes_item_item_len = len(data__edges_item__guard__primes_item_item)
                                                        if data__edges_item__guard__primes_item_item_len < 2:
                                                            raise JsonSchemaValueException("" + (name_prefix or "data") + ".edges[{data__edges_x}].guard.primes[{data__edges_item__guard__primes_x}][{data__edges_item__guard__primes_item_x}]".format(**locals()) + " must contain at least 2 items", "" + (name_prefix or "data") + ".edges[{data__edges_x}].guard.primes[{data__edges_item__guard__primes_x}][{data__edges_item__guard__primes_item_x}]".format(**locals()) + "", 'minItems')
                                                        if data__edges_item__guard__primes_item_item_len > 2:
                                                            raise JsonSchemaValueException("" + (name_prefix or "data") + ".edges[{data__edges_x}].guard.primes[{data__edges_item__guard__primes_x}][{data__edges_item__guard__primes_item_x}]".format(**locals()) + " must contain less than or equal to 2 items", "" + (name_prefix or "data") + ".edges[{data__edges_x}].guard.primes[{data__edges_item__guard__primes_x}][{data__edges_item__guard__primes_item_x}]".format(**locals()) + "", 'maxItems')
                                                        if data__edges_item__guard__primes_item_item_len > 0:
                                                            data__edges_item__guard__primes_item_item__0 = data__edges_item__guard__primes_item_item[0]
                                                            if not isinstance(data__edges_item__guard__primes_item_item__0, (int)) and not (isinstance(data__edges_item__guard__primes_item_item__0, float) and data__edges_item__guard__primes_item_item__0.is_integer()) or isinstance(data__edges_item__guard__primes_item_item__0, bool):
                                                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".edges[{data__edges_x}].guard.primes[{data__edges_item__guard__primes_x}][{data__edges_item__guard__primes_item_x}][0]".format(**locals()) + " must be integer", "" + (name_prefix or "data") + ".edges[{data__edges_x}].guard.primes[{data__edges_item__guard__primes_x}][{data__edges_item__guard__primes_item_x}][0]".format(**locals()) + "", 'type')
                                                            if isinstance(data__edges_item__guard__primes_item_item__0, (int, float)) and not isinstance(data__edges_item__guard__primes_item_item__0, bool):
                                                                if data__edges_item__guard__primes_item_item__0 < 0:
                                                                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".edges[{data__edges_x}].guard.primes[{data__edges_item__guard__primes_x}][{data__edges_item__guard__primes_item_x}][0]".format(**locals()) + " must be bigger than or equal to 0", "" + (name_prefix or "data") + ".edges[{data__edges_x}].guard.primes[{data__edges_item__guard__primes_x}][{data__edges_item__guard__primes_item_x}][0]".format(**locals()) + "", 'minimum')
                                                        if data__edges_item__guard__primes_item_item_len > 1:
                                                            data__edges_item__guard__primes_item_item__1 = data__edges_item__guard__primes_item_item[1]
                                                            if not isinstance(data__edges_item__guard__primes_item_item__1, (bool)):
                                                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".edges[{data__edges_x}].guard.primes[{data__edges_item__guard__primes_x}][{data__edges_item__guard__primes_item_x}][1]".format(**locals()) + " must be boolean", "" + (name_prefix or "data") + ".edges[{data__edges_x}].guard.primes[{data__edges_item__guard__primes_x}][{data__edges_item__guard__primes_item_x}][1]".format(**locals()) + "", 'type')
        if "spec_size" in data_keys:
            data_keys.remove("spec_size")
            data__specsize = data["spec_size"]
            if not isinstance(data__specsize, (int)) and not (isinstance(data__specsize, float) and data__specsize.is_integer()) or isinstance(data__specsize, bool):
                raise JsonSchemaValueException("" + (name_prefix or "data") + ".spec_size must be integer", "" + (name_prefix or "data") + ".spec_size", 'type')
            if isinstance(data__specsize, (int, float)) and not isinstance(data__specsize, bool):
                if data__specsize < 0:
                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".spec_size must be bigger than or equal to 0", "" + (name_prefix or "data") + ".spec_size", 'minimum')
        if "acceptance" in data_keys:
            data_keys.remove("acceptance")
            data__acceptance = data["acceptance"]
            if not isinstance(data__acceptance, (dict)):
                raise JsonSchemaValueException("" + (name_prefix or "data") + ".acceptance must be object", "" + (name_prefix or "data") + ".acceptance", 'type')
            data__acceptance_is_dict = isinstance(data__acceptance, dict)
            if data__acceptance_is_dict:
                data__acceptance__missing_keys = set(['pairs']) - data__acceptance.keys()
                if data__acceptance__missing_keys:
                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".acceptance must contain " + (str(sorted(data__acceptance__missing_keys)) + " properties"), "" + (name_prefix or "data") + ".acceptance", 'required')
                data__acceptance_keys = set(data__acceptance.keys())
                if "pairs" in data__acceptance_keys:
                    data__acceptance_keys.remove("pairs")
                    data__acceptance__pairs = data__acceptance["pairs"]
                    if not isinstance(data__acceptance__pairs, (list, tuple)):
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".acceptance.pairs must be array", "" + (name_prefix or "data") + ".acceptance.pairs", 'type')
                    data__acceptance__pairs_is_list = isinstance(data__acceptance__pairs, (list, tuple))
                    if data__acceptance__pairs_is_list:
                        data__acceptance__pairs_len = len(data__acceptance__pairs)
                        for data__acceptance__pairs_x, data__acceptance__pairs_item in enumerate(data__acceptance__pairs):
                            if not isinstance(data__acceptance__pairs_item, (dict)):
                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".acceptance.pairs[{data__acceptance__pairs_x}]".format(**locals()) + " must be object", "" + (name_prefix or "data") + ".acceptance.pairs[{data__acceptance__pairs_x}]".format(**locals()) + "", 'type')
                            data__acceptance__pairs_item_is_dict = isinstance(data__acceptance__pairs_item, dict)
                            if data__acceptance__pairs_item_is_dict:
                                data__acceptance__pairs_item__missing_keys = set(['fin', 'inf']) - data__acceptance__pairs_item.keys()
                                if data__acceptance__pairs_item__missing_keys:
                                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".acceptance.pairs[{data__acceptance__pairs_x}]".format(**locals()) + " must contain " + (str(sorted(data__acceptance__pairs_item__missing_keys)) + " properties"), "" + (name_prefix or "data") + ".acceptance.pairs[{data__acceptance__pairs_x}]".format(**locals()) + "", 'required')
                                data__acceptance__pairs_item_keys = set(data__acceptance__pairs_item.keys())
                                if "fin" in data__acceptance__pairs_item_keys:
                                    data__acceptance__pairs_item_keys.remove("fin")
                                    data__acceptance__pairs_item__fin = data__acceptance__pairs_item["fin"]
                                    if not isinstance(data__acceptance__pairs_item__fin, (list, tuple)):
                                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".acceptance.pairs[{data__acceptance__pairs_x}].fin".format(**locals()) + " must be array", "" + (name_prefix or "data") + ".acceptance.pairs[{data__acceptance__pairs_x}].fin".format(**locals()) + "", 'type')
                                    data__acceptance__pairs_item__fin_is_list = isinstance(data__acceptance__pairs_item__fin, (list, tuple))
                                    if data__acceptance__pairs_item__fin_is_list:
                                        data__acceptance__pairs_item__fin_len = len(data__acceptance__pairs_item__fin)
                                        for data__acceptance__pairs_item__fin_x, data__acceptance__pairs_item__fin_item in enumerate(data__acceptance__pairs_item__fin):
                                            if not isinstance(data__acceptance__pairs_item__fin_item, (int)) and not (isinstance(data__acceptance__pairs_item__fin_item, float) and data__acceptance__pairs_item__fin_item.is_integer()) or isinstance(data__acceptance__pairs_item__fin_item, bool):
                                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".acceptance.pairs[{data__acceptance__pairs_x}].fin[{data__acceptance__pairs_item__fin_x}]".format(**locals()) + " must be integer", "" + (name_prefix or "data") + ".acceptance.pairs[{data__acceptance__pairs_x}].fin[{data__acceptance__pairs_item__fin_x}]".format(**locals()) + "", 'type')
                                            if isinstance(data__acceptance__pairs_item__fin_item, (int, float)) and not isinstance(data__acceptance__pairs_item__fin_item, bool):
                                                if data__acceptance__pairs_item__fin_item < 0:
                                                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".acceptance.pairs[{data__acceptance__pairs_x}].fin[{data__acceptance__pairs_item__fin_x}]".format(**locals()) + " must be bigger than or equal to 0", "" + (name_prefix or "data") + ".acceptance.pairs[{data__acceptance__pairs_x}].fin[{data__acceptance__pairs_item__fin_x}]".format(**locals()) + "", 'minimum')
                                if "inf" in data__acceptance__pairs_item_keys:
                                    data__acceptance__pairs_item_keys.remove("inf")
                                    data__acceptance__pairs_item__inf = data__acceptance__pairs_item["inf"]
                                    if not isinstance(data__acceptance__pairs_item__inf, (list, tuple)):
                                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".acceptance.pairs[{data__acceptance__pairs_x}].inf".format(**locals()) + " must be array", "" + (name_prefix or "data") + ".acceptance.pairs[{data__acceptance__pairs_x}].inf".format(**locals()) + "", 'type')
                                    data__acceptance__pairs_item__inf_is_list = isinstance(data__acceptance__pairs_item__inf, (list, tuple))
                                    if data__acceptance__pairs_item__inf_is_list:
                                        data__acceptance__pairs_item__inf_len = len(data__acceptance__pairs_item__inf)
                                        for data__acceptance__pairs_item__inf_x, data__acceptance__pairs_item__inf_item in enumerate(data__acceptance__pairs_item__inf):
                                            if not isinstance(data__acceptance__pairs_item__inf_item, (int)) and not (isinstance(data__acceptance__pairs_item__inf_item, float) and data__acceptance__pairs_item__inf_item.is_integer()) or isinstance(data__acceptance__pairs_item__inf_item, bool):
                                                raise JsonSchemaValueException("" + (name_prefix or "data") + ".acceptance.pairs[{data__acceptance__pairs_x}].inf[{data__acceptance__pairs_item__inf_x}]".format(**locals()) + " must be integer", "" + (name_prefix or "data") + ".acceptance.pairs[{data__acceptance__pairs_x}].inf[{data__acceptance__pairs_item__inf_x}]".format(**locals()) + "", 'type')
                                            if isinstance(data__acceptance__pairs_item__inf_item, (int, float)) and not isinstance(data__acceptance__pairs_item__inf_item, bool):
                                                if data__acceptance__pairs_item__inf_item < 0:
                                                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".acceptance.pairs[{data__acceptance__pairs_x}].inf[{data__acceptance__pairs_item__inf_x}]".format(**locals()) + " must be bigger than or equal to 0", "" + (name_prefix or "data") + ".acceptance.pairs[{data__acceptance__pairs_x}].inf[{data__acceptance__pairs_item__inf_x}]".format(**locals()) + "", 'minimum')
    try:
        data_is_dict = isinstance(data, dict)
        if data_is_dict:
            data__missing_keys = set(['semantics']) - data.keys()
            if data__missing_keys:
                raise JsonSchemaValueException("" + (name_prefix or "data") + " must contain " + (str(sorted(data__missing_keys)) + " properties"), "" + (name_prefix or "data") + "", 'required')
            data_keys = set(data.keys())
            if "semantics" in data_keys:
                data_keys.remove("semantics")
                data__semantics = data["semantics"]
                if not (isinstance(data__semantics, str) and data__semantics == 'infinite'):
                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".semantics must be one of ['infinite']", "" + (name_prefix or "data") + ".semantics", 'enum')
    except JsonSchemaValueException:
        pass
    else:
        data_is_dict = isinstance(data, dict)
        if data_is_dict:
            data__missing_keys = set(['acceptance']) - data.keys()
            if data__missing_keys:
                raise JsonSchemaValueException("" + (name_prefix or "data") + " must contain " + (str(sorted(data__missing_keys)) + " properties"), "" + (name_prefix or "data") + "", 'required')
    return data

def validate___definitions_expression(data: object, custom_formats: object = {}, name_prefix: object = None) -> object:
    if not isinstance(data, (dict)):
        raise JsonSchemaValueException("" + (name_prefix or "data") + " must be object", "" + (name_prefix or "data") + "", 'type')
    try:
        data_is_dict = isinstance(data, dict)
        if data_is_dict:
            data__missing_keys = set(['op']) - data.keys()
            if data__missing_keys:
                raise JsonSchemaValueException("" + (name_prefix or "data") + " must contain " + (str(sorted(data__missing_keys)) + " properties"), "" + (name_prefix or "data") + "", 'required')
            data_keys = set(data.keys())
            if "op" in data_keys:
                data_keys.remove("op")
                data__op = data["op"]
                if not (isinstance(data__op, str) and data__op == '+' or isinstance(data__op, str) and data__op == '-' or isinstance(data__op, str) and data__op == '*' or isinstance(data__op, str) and data__op == '/' or isinstance(data__op, str) and data__op == '^'):
                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".op must be one of ['+', '-', '*', '/', '^']", "" + (name_prefix or "data") + ".op", 'enum')
    except JsonSchemaValueException:
        pass
    else:
        data_is_dict = isinstance(data, dict)
        if data_is_dict:
            data_keys = set(data.keys())
            if "args" in data_keys:
                data_keys.remove("args")
                data__args = data["args"]
                data__args_is_list = isinstance(data__args, (list, tuple))
                if data__args_is_list:
                    data__args_len = len(data__args)
                    if data__args_len < 2:
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".args must contain at least 2 items", "" + (name_prefix or "data") + ".args", 'minItems')
                    if data__args_len > 2:
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".args must contain less than or equal to 2 items", "" + (name_prefix or "data") + ".args", 'maxItems')
    try:
        data_is_dict = isinstance(data, dict)
        if data_is_dict:
            data__missing_keys = set(['op']) - data.keys()
            if data__missing_keys:
                raise JsonSchemaValueException("" + (name_prefix or "data") + " must contain " + (str(sorted(data__missing_keys)) + " properties"), "" + (name_prefix or "data") + "", 'required')
            data_keys = set(data.keys())
            if "op" in data_keys:
                data_keys.remove("op")
                data__op = data["op"]
                if not (isinstance(data__op, str) and data__op == 'neg' or isinstance(data__op, str) and data__op == 'abs' or isinstance(data__op, str) and data__op == 'sqrt' or isinstance(data__op, str) and data__op == 'exp' or isinstance(data__op, str) and data__op == 'tanh'):
                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".op must be one of ['neg', 'abs', 'sqrt', 'exp', 'tanh']", "" + (name_prefix or "data") + ".op", 'enum')
    except JsonSchemaValueException:
        pass
    else:
        data_is_dict = isinstance(data, dict)
        if data_is_dict:
            data_keys = set(data.keys())
            if "args" in data_keys:
                data_keys.remove("args")
                data__args = data["args"]
                data__args_is_list = isinstance(data__args, (list, tuple))
                if data__args_is_list:
                    data__args_len = len(data__args)
                    if data__args_len > 1:
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".args must contain less than or equal to 1 items", "" + (name_prefix or "data") + ".args", 'maxItems')
    try:
        data_is_dict = isinstance(data, dict)
        if data_is_dict:
            data__missing_keys = set(['op']) - data.keys()
            if data__missing_keys:
                raise JsonSchemaValueException("" + (name_prefix or "data") + " must contain " + (str(sorted(data__missing_keys)) + " properties"), "" + (name_prefix or "data") + "", 'required')
            data_keys = set(data.keys())
            if "op" in data_keys:
                data_keys.remove("op")
                data__op = data["op"]
                if not (isinstance(data__op, str) and data__op == 'min' or isinstance(data__op, str) and data__op == 'max'):
                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".op must be one of ['min', 'max']", "" + (name_prefix or "data") + ".op", 'enum')
    except JsonSchemaValueException:
        pass
    else:
        data_is_dict = isinstance(data, dict)
        if data_is_dict:
            data_keys = set(data.keys())
            if "args" in data_keys:
                data_keys.remove("args")
                data__args = data["args"]
                data__args_is_list = isinstance(data__args, (list, tuple))
                if data__args_is_list:
                    data__args_len = len(data__args)
                    if data__args_len < 2:
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".args must contain at least 2 items", "" + (name_prefix or "data") + ".args", 'minItems')
    try:
        data_is_dict = isinstance(data, dict)
        if data_is_dict:
            data__missing_keys = set(['op']) - data.keys()
            if data__missing_keys:
                raise JsonSchemaValueException("" + (name_prefix or "data") + " must contain " + (str(sorted(data__missing_keys)) + " properties"), "" + (name_prefix or "data") + "", 'required')
            data_keys = set(data.keys())
            if "op" in data_keys:
                data_keys.remove("op")
                data__op = data["op"]
                if not (isinstance(data__op, str) and data__op == 'clamp'):
                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".op must be one of ['clamp']", "" + (name_prefix or "data") + ".op", 'enum')
    except JsonSchemaValueException:
        pass
    else:
        data_is_dict = isinstance(data, dict)
        if data_is_dict:
            data_keys = set(data.keys())
            if "args" in data_keys:
                data_keys.remove("args")
                data__args = data["args"]
                data__args_is_list = isinstance(data__args, (list, tuple))
                if data__args_is_list:
                    data__args_len = len(data__args)
                    if data__args_len < 3:
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".args must contain at least 3 items", "" + (name_prefix or "data") + ".args", 'minItems')
                    if data__args_len > 3:
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".args must contain less than or equal to 3 items", "" + (name_prefix or "data") + ".args", 'maxItems')
    data_is_dict = isinstance(data, dict)
    if data_is_dict:
        data_len = len(data)
        if data_len < 1:
            raise JsonSchemaValueException("" + (name_prefix or "data") + " must contain at least 1 properties", "" + (name_prefix or "data") + "", 'minProperties')
        if "op" in data:
            data_is_dict = isinstance(data, dict)
            if data_is_dict:
                data_len = len(data)
                if data_len > 2:
                    raise JsonSchemaValueException("" + (name_prefix or "data") + " must contain less than or equal to 2 properties", "" + (name_prefix or "data") + "", 'maxProperties')
                data__missing_keys = set(['args']) - data.keys()
                if data__missing_keys:
                    raise JsonSchemaValueException("" + (name_prefix or "data") + " must contain " + (str(sorted(data__missing_keys)) + " properties"), "" + (name_prefix or "data") + "", 'required')
        if "args" in data:
            if "op" not in data:
                raise JsonSchemaValueException("" + (name_prefix or "data") + " missing dependency op for args", "" + (name_prefix or "data") + "", 'dependencies')
        if "signal" in data:
            data_is_dict = isinstance(data, dict)
            if data_is_dict:
                data_len = len(data)
                if data_len > 1:
                    raise JsonSchemaValueException("" + (name_prefix or "data") + " must contain less than or equal to 1 properties", "" + (name_prefix or "data") + "", 'maxProperties')
        if "param" in data:
            data_is_dict = isinstance(data, dict)
            if data_is_dict:
                data_len = len(data)
                if data_len > 1:
                    raise JsonSchemaValueException("" + (name_prefix or "data") + " must contain less than or equal to 1 properties", "" + (name_prefix or "data") + "", 'maxProperties')
        if "const" in data:
            data_is_dict = isinstance(data, dict)
            if data_is_dict:
                data_len = len(data)
                if data_len > 1:
                    raise JsonSchemaValueException("" + (name_prefix or "data") + " must contain less than or equal to 1 properties", "" + (name_prefix or "data") + "", 'maxProperties')
        if "when" in data:
            data_is_dict = isinstance(data, dict)
            if data_is_dict:
                data_len = len(data)
                if data_len > 2:
                    raise JsonSchemaValueException("" + (name_prefix or "data") + " must contain less than or equal to 2 properties", "" + (name_prefix or "data") + "", 'maxProperties')
                data__missing_keys = set(['otherwise']) - data.keys()
                if data__missing_keys:
                    raise JsonSchemaValueException("" + (name_prefix or "data") + " must contain " + (str(sorted(data__missing_keys)) + " properties"), "" + (name_prefix or "data") + "", 'required')
        if "otherwise" in data:
            if "when" not in data:
                raise JsonSchemaValueException("" + (name_prefix or "data") + " missing dependency when for otherwise", "" + (name_prefix or "data") + "", 'dependencies')
        data_keys = set(data.keys())
        if "op" in data_keys:
            data_keys.remove("op")
            data__op = data["op"]
            if not (isinstance(data__op, str) and data__op == '+' or isinstance(data__op, str) and data__op == '-' or isinstance(data__op, str) and data__op == '*' or isinstance(data__op, str) and data__op == '/' or isinstance(data__op, str) and data__op == '^' or isinstance(data__op, str) and data__op == 'neg' or isinstance(data__op, str) and data__op == 'min' or isinstance(data__op, str) and data__op == 'max' or isinstance(data__op, str) and data__op == 'abs' or isinstance(data__op, str) and data__op == 'clamp' or isinstance(data__op, str) and data__op == 'sqrt' or isinstance(data__op, str) and data__op == 'exp' or isinstance(data__op, str) and data__op == 'tanh'):
                raise JsonSchemaValueException("" + (name_prefix or "data") + ".op must be one of ['+', '-', '*', '/', '^', 'neg', 'min', 'max', 'abs', 'clamp', 'sqrt', 'exp', 'tanh']", "" + (name_prefix or "data") + ".op", 'enum')
        if "args" in data_keys:
            data_keys.remove("args")
            data__args = data["args"]
            if not isinstance(data__args, (list, tuple)):
                raise JsonSchemaValueException("" + (name_prefix or "data") + ".args must be array", "" + (name_prefix or "data") + ".args", 'type')
            data__args_is_list = isinstance(data__args, (list, tuple))
            if data__args_is_list:
                data__args_len = len(data__args)
                if data__args_len < 1:
                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".args must contain at least 1 items", "" + (name_prefix or "data") + ".args", 'minItems')
                for data__args_x, data__args_item in enumerate(data__args):
                    validate___definitions_expression(data__args_item, custom_formats, (name_prefix or "data") + ".args[{data__args_x}]".format(**locals()))
        if "signal" in data_keys:
            data_keys.remove("signal")
            data__signal = data["signal"]
            if not isinstance(data__signal, (str)):
                raise JsonSchemaValueException("" + (name_prefix or "data") + ".signal must be string", "" + (name_prefix or "data") + ".signal", 'type')
            if isinstance(data__signal, str):
                data__signal_len = len(data__signal)
                if data__signal_len < 1:
                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".signal must be longer than or equal to 1 characters", "" + (name_prefix or "data") + ".signal", 'minLength')
        if "param" in data_keys:
            data_keys.remove("param")
            data__param = data["param"]
            if not isinstance(data__param, (str)):
                raise JsonSchemaValueException("" + (name_prefix or "data") + ".param must be string", "" + (name_prefix or "data") + ".param", 'type')
            if isinstance(data__param, str):
                data__param_len = len(data__param)
                if data__param_len < 1:
                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".param must be longer than or equal to 1 characters", "" + (name_prefix or "data") + ".param", 'minLength')
        if "const" in data_keys:
            data_keys.remove("const")
            data__const = data["const"]
            if not isinstance(data__const, (int, float)) or isinstance(data__const, bool):
                raise JsonSchemaValueException("" + (name_prefix or "data") + ".const must be number", "" + (name_prefix or "data") + ".const", 'type')
            if isinstance(data__const, (int, float)) and not isinstance(data__const, bool):
                if data__const < -1.7976931348623157e+308:
                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".const must be bigger than or equal to -1.7976931348623157e+308", "" + (name_prefix or "data") + ".const", 'minimum')
                if data__const > 1.7976931348623157e+308:
                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".const must be smaller than or equal to 1.7976931348623157e+308", "" + (name_prefix or "data") + ".const", 'maximum')
        if "when" in data_keys:
            data_keys.remove("when")
            data__when = data["when"]
            if not isinstance(data__when, (list, tuple)):
                raise JsonSchemaValueException("" + (name_prefix or "data") + ".when must be array", "" + (name_prefix or "data") + ".when", 'type')
            data__when_is_list = isinstance(data__when, (list, tuple))
            if data__when_is_list:
                data__when_len = len(data__when)
                if data__when_len < 1:
                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".when must contain at least 1 items", "" + (name_prefix or "data") + ".when", 'minItems')
                for data__when_x, data__when_item in enumerate(data__when):
                    if not isinstance(data__when_item, (list, tuple)):
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".when[{data__when_x}]".format(**locals()) + " must be array", "" + (name_prefix or "data") + ".when[{data__when_x}]".format(**locals()) + "", 'type')
                    data__when_item_is_list = isinstance(data__when_item, (list, tuple))
                    if data__when_item_is_list:
                        data__when_item_len = len(data__when_item)
                        if data__when_item_len < 2:
                            raise JsonSchemaValueException("" + (name_prefix or "data") + ".when[{data__when_x}]".format(**locals()) + " must contain at least 2 items", "" + (name_prefix or "data") + ".when[{data__when_x}]".format(**locals()) + "", 'minItems')
                        if data__when_item_len > 2:
                            raise JsonSchemaValueException("" + (name_prefix or "data") + ".when[{data__when_x}]".format(**locals()) + " must contain less than or equal to 2 items", "" + (name_prefix or "data") + ".when[{data__when_x}]".format(**locals()) + "", 'maxItems')
                        if data__when_item_len > 0:
                            data__when_item__0 = data__when_item[0]
                            validate___definitions_condition(data__when_item__0, custom_formats, (name_prefix or "data") + ".when[{data__when_x}][0]".format(**locals()))
                        if data__when_item_len > 1:
                            data__when_item__1 = data__when_item[1]
                            validate___definitions_expression(data__when_item__1, custom_formats, (name_prefix or "data") + ".when[{data__when_x}][1]".format(**locals()))
        if "otherwise" in data_keys:
            data_keys.remove("otherwise")
            data__otherwise = data["otherwise"]
            validate___definitions_expression(data__otherwise, custom_formats, (name_prefix or "data") + ".otherwise")
        if data_keys:
            raise JsonSchemaValueException("" + (name_prefix or "data") + " must not contain "+str(sorted(data_keys))+" properties", "" + (name_prefix or "data") + "", 'additionalProperties')
    return data

def validate___definitions_condition(data: object, custom_formats: object = {}, name_prefix: object = None) -> object:
    if not isinstance(data, (dict)):
        raise JsonSchemaValueException("" + (name_prefix or "data") + " must be object", "" + (name_prefix or "data") + "", 'type')
    data_is_dict = isinstance(data, dict)
    if data_is_dict:
        data__missing_keys = set(['op', 'args']) - data.keys()
        if data__missing_keys:
            raise JsonSchemaValueException("" + (name_prefix or "data") + " must contain " + (str(sorted(data__missing_keys)) + " properties"), "" + (name_prefix or "data") + "", 'required')
        data_keys = set(data.keys())
        if "op" in data_keys:
            data_keys.remove("op")
            data__op = data["op"]
            if not (isinstance(data__op, str) and data__op == '<' or isinstance(data__op, str) and data__op == '<=' or isinstance(data__op, str) and data__op == '>' or isinstance(data__op, str) and data__op == '>=' or isinstance(data__op, str) and data__op == 'and' or isinstance(data__op, str) and data__op == 'or' or isinstance(data__op, str) and data__op == 'not'):
                raise JsonSchemaValueException("" + (name_prefix or "data") + ".op must be one of ['<', '<=', '>', '>=', 'and', 'or', 'not']", "" + (name_prefix or "data") + ".op", 'enum')
        if "args" in data_keys:
            data_keys.remove("args")
            data__args = data["args"]
            if not isinstance(data__args, (list, tuple)):
                raise JsonSchemaValueException("" + (name_prefix or "data") + ".args must be array", "" + (name_prefix or "data") + ".args", 'type')
            data__args_is_list = isinstance(data__args, (list, tuple))
            if data__args_is_list:
                data__args_len = len(data__args)
                if data__args_len < 1:
                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".args must contain at least 1 items", "" + (name_prefix or "data") + ".args", 'minItems')
        if data_keys:
            raise JsonSchemaValueException("" + (name_prefix or "data") + " must not contain "+str(sorted(data_keys))+" properties", "" + (name_prefix or "data") + "", 'additionalProperties')
    try:
        data_is_dict = isinstance(data, dict)
        if data_is_dict:
            data_keys = set(data.keys())
            if "op" in data_keys:
                data_keys.remove("op")
                data__op = data["op"]
                if not (isinstance(data__op, str) and data__op == 'and' or isinstance(data__op, str) and data__op == 'or' or isinstance(data__op, str) and data__op == 'not'):
                    raise JsonSchemaValueException("" + (name_prefix or "data") + ".op must be one of ['and', 'or', 'not']", "" + (name_prefix or "data") + ".op", 'enum')
    except JsonSchemaValueException:
        data_is_dict = isinstance(data, dict)
        if data_is_dict:
            data_keys = set(data.keys())
            if "args" in data_keys:
                data_keys.remove("args")
                data__args = data["args"]
                data__args_is_list = isinstance(data__args, (list, tuple))
                if data__args_is_list:
                    data__args_len = len(data__args)
                    if data__args_len < 2:
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".args must contain at least 2 items", "" + (name_prefix or "data") + ".args", 'minItems')
                    if data__args_len > 2:
                        raise JsonSchemaValueException("" + (name_prefix or "data") + ".args must contain less than or equal to 2 items", "" + (name_prefix or "data") + ".args", 'maxItems')
                    for data__args_x, data__args_item in enumerate(data__args):
                        validate___definitions_expression(data__args_item, custom_formats, (name_prefix or "data") + ".args[{data__args_x}]".format(**locals()))
    else:
        data_is_dict = isinstance(data, dict)
        if data_is_dict:
            data_keys = set(data.keys())
            if "args" in data_keys:
                data_keys.remove("args")
                data__args = data["args"]
                data__args_is_list = isinstance(data__args, (list, tuple))
                if data__args_is_list:
                    data__args_len = len(data__args)
                    for data__args_x, data__args_item in enumerate(data__args):
                        validate___definitions_condition(data__args_item, custom_formats, (name_prefix or "data") + ".args[{data__args_x}]".format(**locals()))
    return data
