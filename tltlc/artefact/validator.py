"""Validates artefacts. Generated from fspa.schema.json by generate.py: do not edit."""
# ruff: noqa
# mypy: ignore-errors
# fmt: off
from tltlc.artefact.errors import JsonSchemaValueException
from tltlc.artefact.locations import JsonPath
import re


REGEX_PATTERNS = {
    '^[A-Za-z_][A-Za-z0-9_]*$': re.compile('^[A-Za-z_][A-Za-z0-9_]*\\Z')
}

NoneType = type(None)

def validate(data: object, custom_formats: object = {}, path: JsonPath = ()) -> object:
    if not isinstance(data, (dict)):
        raise JsonSchemaValueException(path, 'type', 'object')
    try:
        data_is_dict = isinstance(data, dict)
        if data_is_dict:
            data__missing_keys = set(['version']) - data.keys()
            if data__missing_keys:
                raise JsonSchemaValueException(path, 'required', ['version'], sorted(data__missing_keys))
            data_keys = set(data.keys())
            if "version" in data_keys:
                data_keys.remove("version")
                data__version = data["version"]
                if not (isinstance(data__version, (int, float)) and not isinstance(data__version, bool) and data__version == 2):
                    raise JsonSchemaValueException((*path, 'version'), 'enum', [2])
    except JsonSchemaValueException:
        pass
    else:
        data_is_dict = isinstance(data, dict)
        if data_is_dict:
            data__missing_keys = set(['registers']) - data.keys()
            if data__missing_keys:
                raise JsonSchemaValueException(path, 'required', ['registers'], sorted(data__missing_keys))
    data_is_dict = isinstance(data, dict)
    if data_is_dict:
        data__missing_keys = set(['format', 'version', 'spec', 'semantics', 'signals', 'params', 'atoms', 'exclusive', 'states', 'initial', 'edges', 'spec_size']) - data.keys()
        if data__missing_keys:
            raise JsonSchemaValueException(path, 'required', ['format', 'version', 'spec', 'semantics', 'signals', 'params', 'atoms', 'exclusive', 'states', 'initial', 'edges', 'spec_size'], sorted(data__missing_keys))
        if "acceptance" in data:
            data_is_dict = isinstance(data, dict)
            if data_is_dict:
                data_keys = set(data.keys())
                if "semantics" in data_keys:
                    data_keys.remove("semantics")
                    data__semantics = data["semantics"]
                    if not (isinstance(data__semantics, str) and data__semantics == 'infinite'):
                        raise JsonSchemaValueException((*path, 'semantics'), 'enum', ['infinite'])
        if "registers" in data:
            data_is_dict = isinstance(data, dict)
            if data_is_dict:
                data_keys = set(data.keys())
                if "version" in data_keys:
                    data_keys.remove("version")
                    data__version = data["version"]
                    if not (isinstance(data__version, (int, float)) and not isinstance(data__version, bool) and data__version == 2):
                        raise JsonSchemaValueException((*path, 'version'), 'enum', [2])
        data_keys = set(data.keys())
        if "format" in data_keys:
            data_keys.remove("format")
            data__format = data["format"]
            if not (isinstance(data__format, str) and data__format == 'fspa'):
                raise JsonSchemaValueException((*path, 'format'), 'enum', ['fspa'])
        if "version" in data_keys:
            data_keys.remove("version")
            data__version = data["version"]
            if not (isinstance(data__version, (int, float)) and not isinstance(data__version, bool) and data__version == 1 or isinstance(data__version, (int, float)) and not isinstance(data__version, bool) and data__version == 2):
                raise JsonSchemaValueException((*path, 'version'), 'enum', [1, 2])
        if "spec" in data_keys:
            data_keys.remove("spec")
            data__spec = data["spec"]
            if not isinstance(data__spec, (dict)):
                raise JsonSchemaValueException((*path, 'spec'), 'type', 'object')
            data__spec_is_dict = isinstance(data__spec, dict)
            if data__spec_is_dict:
                data__spec__missing_keys = set(['name', 'doc', 'formula', 'limit_steps', 'judge', 'level']) - data__spec.keys()
                if data__spec__missing_keys:
                    raise JsonSchemaValueException((*path, 'spec'), 'required', ['name', 'doc', 'formula', 'limit_steps', 'judge', 'level'], sorted(data__spec__missing_keys))
                data__spec_keys = set(data__spec.keys())
                if "name" in data__spec_keys:
                    data__spec_keys.remove("name")
                    data__spec__name = data__spec["name"]
                    if not isinstance(data__spec__name, (str)):
                        raise JsonSchemaValueException((*path, 'spec', 'name'), 'type', 'string')
                    if isinstance(data__spec__name, str):
                        if not REGEX_PATTERNS['^[A-Za-z_][A-Za-z0-9_]*$'].search(data__spec__name):
                            raise JsonSchemaValueException((*path, 'spec', 'name'), 'pattern', '^[A-Za-z_][A-Za-z0-9_]*$')
                if "doc" in data__spec_keys:
                    data__spec_keys.remove("doc")
                    data__spec__doc = data__spec["doc"]
                    if not isinstance(data__spec__doc, (str)):
                        raise JsonSchemaValueException((*path, 'spec', 'doc'), 'type', 'string')
                if "formula" in data__spec_keys:
                    data__spec_keys.remove("formula")
                    data__spec__formula = data__spec["formula"]
                    if not isinstance(data__spec__formula, (dict)):
                        raise JsonSchemaValueException((*path, 'spec', 'formula'), 'type', 'object')
                    data__spec__formula_is_dict = isinstance(data__spec__formula, dict)
                    if data__spec__formula_is_dict:
                        data__spec__formula__missing_keys = set(['ascii', 'unicode', 'english']) - data__spec__formula.keys()
                        if data__spec__formula__missing_keys:
                            raise JsonSchemaValueException((*path, 'spec', 'formula'), 'required', ['ascii', 'unicode', 'english'], sorted(data__spec__formula__missing_keys))
                        data__spec__formula_keys = set(data__spec__formula.keys())
                        if "ascii" in data__spec__formula_keys:
                            data__spec__formula_keys.remove("ascii")
                            data__spec__formula__ascii = data__spec__formula["ascii"]
                            if not isinstance(data__spec__formula__ascii, (str)):
                                raise JsonSchemaValueException((*path, 'spec', 'formula', 'ascii'), 'type', 'string')
                        if "unicode" in data__spec__formula_keys:
                            data__spec__formula_keys.remove("unicode")
                            data__spec__formula__unicode = data__spec__formula["unicode"]
                            if not isinstance(data__spec__formula__unicode, (str)):
                                raise JsonSchemaValueException((*path, 'spec', 'formula', 'unicode'), 'type', 'string')
                        if "english" in data__spec__formula_keys:
                            data__spec__formula_keys.remove("english")
                            data__spec__formula__english = data__spec__formula["english"]
                            if not isinstance(data__spec__formula__english, (str)):
                                raise JsonSchemaValueException((*path, 'spec', 'formula', 'english'), 'type', 'string')
                if "limit_steps" in data__spec_keys:
                    data__spec_keys.remove("limit_steps")
                    data__spec__limitsteps = data__spec["limit_steps"]
                    if not isinstance(data__spec__limitsteps, (int, NoneType)) and not (isinstance(data__spec__limitsteps, float) and data__spec__limitsteps.is_integer()) or isinstance(data__spec__limitsteps, bool):
                        raise JsonSchemaValueException((*path, 'spec', 'limit_steps'), 'type', ['integer', 'null'])
                    if isinstance(data__spec__limitsteps, (int, float)) and not isinstance(data__spec__limitsteps, bool):
                        if data__spec__limitsteps < 1:
                            raise JsonSchemaValueException((*path, 'spec', 'limit_steps'), 'minimum', 1)
                if "judge" in data__spec_keys:
                    data__spec_keys.remove("judge")
                    data__spec__judge = data__spec["judge"]
                    if not (isinstance(data__spec__judge, str) and data__spec__judge == 'goal' or isinstance(data__spec__judge, str) and data__spec__judge == 'limit'):
                        raise JsonSchemaValueException((*path, 'spec', 'judge'), 'enum', ['goal', 'limit'])
                if "level" in data__spec_keys:
                    data__spec_keys.remove("level")
                    data__spec__level = data__spec["level"]
                    if not isinstance(data__spec__level, (str, NoneType)):
                        raise JsonSchemaValueException((*path, 'spec', 'level'), 'type', ['string', 'null'])
                if "tags" in data__spec_keys:
                    data__spec_keys.remove("tags")
                    data__spec__tags = data__spec["tags"]
                    if not isinstance(data__spec__tags, (list, tuple)):
                        raise JsonSchemaValueException((*path, 'spec', 'tags'), 'type', 'array')
                    data__spec__tags_is_list = isinstance(data__spec__tags, (list, tuple))
                    if data__spec__tags_is_list:
                        data__spec__tags_len = len(data__spec__tags)
                        for data__spec__tags_x, data__spec__tags_item in enumerate(data__spec__tags):
                            if not isinstance(data__spec__tags_item, (str)):
                                raise JsonSchemaValueException((*path, 'spec', 'tags', data__spec__tags_x), 'type', 'string')
                if "clock_s" in data__spec_keys:
                    data__spec_keys.remove("clock_s")
                    data__spec__clocks = data__spec["clock_s"]
                    if not isinstance(data__spec__clocks, (int, float, NoneType)) or isinstance(data__spec__clocks, bool):
                        raise JsonSchemaValueException((*path, 'spec', 'clock_s'), 'type', ['number', 'null'])
                    if isinstance(data__spec__clocks, (int, float)) and not isinstance(data__spec__clocks, bool):
                        if data__spec__clocks > 1e+300:
                            raise JsonSchemaValueException((*path, 'spec', 'clock_s'), 'maximum', 1e+300)
                        if data__spec__clocks <= 0:
                            raise JsonSchemaValueException((*path, 'spec', 'clock_s'), 'exclusiveMinimum', 0)
                if "clock_varies" in data__spec_keys:
                    data__spec_keys.remove("clock_varies")
                    data__spec__clockvaries = data__spec["clock_varies"]
                    if not isinstance(data__spec__clockvaries, (bool)):
                        raise JsonSchemaValueException((*path, 'spec', 'clock_varies'), 'type', 'boolean')
                if "clauses" in data__spec_keys:
                    data__spec_keys.remove("clauses")
                    data__spec__clauses = data__spec["clauses"]
                    if not isinstance(data__spec__clauses, (list, tuple)):
                        raise JsonSchemaValueException((*path, 'spec', 'clauses'), 'type', 'array')
                    data__spec__clauses_is_list = isinstance(data__spec__clauses, (list, tuple))
                    if data__spec__clauses_is_list:
                        data__spec__clauses_len = len(data__spec__clauses)
                        for data__spec__clauses_x, data__spec__clauses_item in enumerate(data__spec__clauses):
                            if not isinstance(data__spec__clauses_item, (str)):
                                raise JsonSchemaValueException((*path, 'spec', 'clauses', data__spec__clauses_x), 'type', 'string')
        if "semantics" in data_keys:
            data_keys.remove("semantics")
            data__semantics = data["semantics"]
            if not (isinstance(data__semantics, str) and data__semantics == 'finite' or isinstance(data__semantics, str) and data__semantics == 'infinite'):
                raise JsonSchemaValueException((*path, 'semantics'), 'enum', ['finite', 'infinite'])
        if "signals" in data_keys:
            data_keys.remove("signals")
            data__signals = data["signals"]
            if not isinstance(data__signals, (list, tuple)):
                raise JsonSchemaValueException((*path, 'signals'), 'type', 'array')
            data__signals_is_list = isinstance(data__signals, (list, tuple))
            if data__signals_is_list:
                data__signals_len = len(data__signals)
                for data__signals_x, data__signals_item in enumerate(data__signals):
                    if not isinstance(data__signals_item, (dict)):
                        raise JsonSchemaValueException((*path, 'signals', data__signals_x), 'type', 'object')
                    data__signals_item_is_dict = isinstance(data__signals_item, dict)
                    if data__signals_item_is_dict:
                        data__signals_item__missing_keys = set(['name', 'type', 'range']) - data__signals_item.keys()
                        if data__signals_item__missing_keys:
                            raise JsonSchemaValueException((*path, 'signals', data__signals_x), 'required', ['name', 'type', 'range'], sorted(data__signals_item__missing_keys))
                        data__signals_item_keys = set(data__signals_item.keys())
                        if "name" in data__signals_item_keys:
                            data__signals_item_keys.remove("name")
                            data__signals_item__name = data__signals_item["name"]
                            if not isinstance(data__signals_item__name, (str)):
                                raise JsonSchemaValueException((*path, 'signals', data__signals_x, 'name'), 'type', 'string')
                            if isinstance(data__signals_item__name, str):
                                data__signals_item__name_len = len(data__signals_item__name)
                                if data__signals_item__name_len < 1:
                                    raise JsonSchemaValueException((*path, 'signals', data__signals_x, 'name'), 'minLength', 1)
                        if "type" in data__signals_item_keys:
                            data__signals_item_keys.remove("type")
                            data__signals_item__type = data__signals_item["type"]
                            if not (isinstance(data__signals_item__type, str) and data__signals_item__type == 'number' or isinstance(data__signals_item__type, str) and data__signals_item__type == 'ratio' or isinstance(data__signals_item__type, str) and data__signals_item__type == 'length' or isinstance(data__signals_item__type, str) and data__signals_item__type == 'time' or isinstance(data__signals_item__type, str) and data__signals_item__type == 'speed' or isinstance(data__signals_item__type, str) and data__signals_item__type == 'angle' or isinstance(data__signals_item__type, str) and data__signals_item__type == 'int' or isinstance(data__signals_item__type, str) and data__signals_item__type == 'bool'):
                                raise JsonSchemaValueException((*path, 'signals', data__signals_x, 'type'), 'enum', ['number', 'ratio', 'length', 'time', 'speed', 'angle', 'int', 'bool'])
                        if "range" in data__signals_item_keys:
                            data__signals_item_keys.remove("range")
                            data__signals_item__range = data__signals_item["range"]
                            if not isinstance(data__signals_item__range, (list, tuple)):
                                raise JsonSchemaValueException((*path, 'signals', data__signals_x, 'range'), 'type', 'array')
                            data__signals_item__range_is_list = isinstance(data__signals_item__range, (list, tuple))
                            if data__signals_item__range_is_list:
                                data__signals_item__range_len = len(data__signals_item__range)
                                if data__signals_item__range_len < 2:
                                    raise JsonSchemaValueException((*path, 'signals', data__signals_x, 'range'), 'minItems', 2)
                                if data__signals_item__range_len > 2:
                                    raise JsonSchemaValueException((*path, 'signals', data__signals_x, 'range'), 'maxItems', 2)
                                for data__signals_item__range_x, data__signals_item__range_item in enumerate(data__signals_item__range):
                                    if not isinstance(data__signals_item__range_item, (int, float, NoneType)) or isinstance(data__signals_item__range_item, bool):
                                        raise JsonSchemaValueException((*path, 'signals', data__signals_x, 'range', data__signals_item__range_x), 'type', ['number', 'null'])
                                    if isinstance(data__signals_item__range_item, (int, float)) and not isinstance(data__signals_item__range_item, bool):
                                        if data__signals_item__range_item < -1.7976931348623157e+308:
                                            raise JsonSchemaValueException((*path, 'signals', data__signals_x, 'range', data__signals_item__range_x), 'minimum', -1.7976931348623157e+308)
                                        if data__signals_item__range_item > 1.7976931348623157e+308:
                                            raise JsonSchemaValueException((*path, 'signals', data__signals_x, 'range', data__signals_item__range_x), 'maximum', 1.7976931348623157e+308)
                        if "values" in data__signals_item_keys:
                            data__signals_item_keys.remove("values")
                            data__signals_item__values = data__signals_item["values"]
                            if not isinstance(data__signals_item__values, (list, tuple)):
                                raise JsonSchemaValueException((*path, 'signals', data__signals_x, 'values'), 'type', 'array')
                            data__signals_item__values_is_list = isinstance(data__signals_item__values, (list, tuple))
                            if data__signals_item__values_is_list:
                                data__signals_item__values_len = len(data__signals_item__values)
                                if data__signals_item__values_len < 2:
                                    raise JsonSchemaValueException((*path, 'signals', data__signals_x, 'values'), 'minItems', 2)
                                def fn(var): return frozenset(dict((k, fn(v)) for k, v in var.items()).items()) if hasattr(var, "items") else tuple(fn(v) for v in var) if isinstance(var, (dict, list)) else (bool, var) if isinstance(var, bool) else var
                                if data__signals_item__values_len > len(set(fn(data__signals_item__values_x) for data__signals_item__values_x in data__signals_item__values)):
                                    raise JsonSchemaValueException((*path, 'signals', data__signals_x, 'values'), 'uniqueItems', True)
                                for data__signals_item__values_x, data__signals_item__values_item in enumerate(data__signals_item__values):
                                    if not isinstance(data__signals_item__values_item, (str)):
                                        raise JsonSchemaValueException((*path, 'signals', data__signals_x, 'values', data__signals_item__values_x), 'type', 'string')
                                    if isinstance(data__signals_item__values_item, str):
                                        data__signals_item__values_item_len = len(data__signals_item__values_item)
                                        if data__signals_item__values_item_len < 1:
                                            raise JsonSchemaValueException((*path, 'signals', data__signals_x, 'values', data__signals_item__values_x), 'minLength', 1)
                        if "doc" in data__signals_item_keys:
                            data__signals_item_keys.remove("doc")
                            data__signals_item__doc = data__signals_item["doc"]
                            if not isinstance(data__signals_item__doc, (str)):
                                raise JsonSchemaValueException((*path, 'signals', data__signals_x, 'doc'), 'type', 'string')
        if "params" in data_keys:
            data_keys.remove("params")
            data__params = data["params"]
            if not isinstance(data__params, (list, tuple)):
                raise JsonSchemaValueException((*path, 'params'), 'type', 'array')
            data__params_is_list = isinstance(data__params, (list, tuple))
            if data__params_is_list:
                data__params_len = len(data__params)
                for data__params_x, data__params_item in enumerate(data__params):
                    if not isinstance(data__params_item, (dict)):
                        raise JsonSchemaValueException((*path, 'params', data__params_x), 'type', 'object')
                    data__params_item_is_dict = isinstance(data__params_item, dict)
                    if data__params_item_is_dict:
                        data__params_item__missing_keys = set(['name', 'type', 'value']) - data__params_item.keys()
                        if data__params_item__missing_keys:
                            raise JsonSchemaValueException((*path, 'params', data__params_x), 'required', ['name', 'type', 'value'], sorted(data__params_item__missing_keys))
                        data__params_item_keys = set(data__params_item.keys())
                        if "name" in data__params_item_keys:
                            data__params_item_keys.remove("name")
                            data__params_item__name = data__params_item["name"]
                            if not isinstance(data__params_item__name, (str)):
                                raise JsonSchemaValueException((*path, 'params', data__params_x, 'name'), 'type', 'string')
                            if isinstance(data__params_item__name, str):
                                data__params_item__name_len = len(data__params_item__name)
                                if data__params_item__name_len < 1:
                                    raise JsonSchemaValueException((*path, 'params', data__params_x, 'name'), 'minLength', 1)
                        if "type" in data__params_item_keys:
                            data__params_item_keys.remove("type")
                            data__params_item__type = data__params_item["type"]
                            if not (isinstance(data__params_item__type, str) and data__params_item__type == 'number' or isinstance(data__params_item__type, str) and data__params_item__type == 'ratio' or isinstance(data__params_item__type, str) and data__params_item__type == 'length' or isinstance(data__params_item__type, str) and data__params_item__type == 'time' or isinstance(data__params_item__type, str) and data__params_item__type == 'speed' or isinstance(data__params_item__type, str) and data__params_item__type == 'angle' or isinstance(data__params_item__type, str) and data__params_item__type == 'int' or isinstance(data__params_item__type, str) and data__params_item__type == 'bool'):
                                raise JsonSchemaValueException((*path, 'params', data__params_x, 'type'), 'enum', ['number', 'ratio', 'length', 'time', 'speed', 'angle', 'int', 'bool'])
                        if "value" in data__params_item_keys:
                            data__params_item_keys.remove("value")
                            data__params_item__value = data__params_item["value"]
                            if not isinstance(data__params_item__value, (int, float)) or isinstance(data__params_item__value, bool):
                                raise JsonSchemaValueException((*path, 'params', data__params_x, 'value'), 'type', 'number')
                            if isinstance(data__params_item__value, (int, float)) and not isinstance(data__params_item__value, bool):
                                if data__params_item__value < -1.7976931348623157e+308:
                                    raise JsonSchemaValueException((*path, 'params', data__params_x, 'value'), 'minimum', -1.7976931348623157e+308)
                                if data__params_item__value > 1.7976931348623157e+308:
                                    raise JsonSchemaValueException((*path, 'params', data__params_x, 'value'), 'maximum', 1.7976931348623157e+308)
                        if "range" in data__params_item_keys:
                            data__params_item_keys.remove("range")
                            data__params_item__range = data__params_item["range"]
                            if not isinstance(data__params_item__range, (list, tuple)):
                                raise JsonSchemaValueException((*path, 'params', data__params_x, 'range'), 'type', 'array')
                            data__params_item__range_is_list = isinstance(data__params_item__range, (list, tuple))
                            if data__params_item__range_is_list:
                                data__params_item__range_len = len(data__params_item__range)
                                if data__params_item__range_len < 2:
                                    raise JsonSchemaValueException((*path, 'params', data__params_x, 'range'), 'minItems', 2)
                                if data__params_item__range_len > 2:
                                    raise JsonSchemaValueException((*path, 'params', data__params_x, 'range'), 'maxItems', 2)
                                for data__params_item__range_x, data__params_item__range_item in enumerate(data__params_item__range):
                                    if not isinstance(data__params_item__range_item, (int, float, NoneType)) or isinstance(data__params_item__range_item, bool):
                                        raise JsonSchemaValueException((*path, 'params', data__params_x, 'range', data__params_item__range_x), 'type', ['number', 'null'])
                                    if isinstance(data__params_item__range_item, (int, float)) and not isinstance(data__params_item__range_item, bool):
                                        if data__params_item__range_item < -1.7976931348623157e+308:
                                            raise JsonSchemaValueException((*path, 'params', data__params_x, 'range', data__params_item__range_x), 'minimum', -1.7976931348623157e+308)
                                        if data__params_item__range_item > 1.7976931348623157e+308:
                                            raise JsonSchemaValueException((*path, 'params', data__params_x, 'range', data__params_item__range_x), 'maximum', 1.7976931348623157e+308)
                        if "doc" in data__params_item_keys:
                            data__params_item_keys.remove("doc")
                            data__params_item__doc = data__params_item["doc"]
                            if not isinstance(data__params_item__doc, (str)):
                                raise JsonSchemaValueException((*path, 'params', data__params_x, 'doc'), 'type', 'string')
        if "atoms" in data_keys:
            data_keys.remove("atoms")
            data__atoms = data["atoms"]
            if not isinstance(data__atoms, (list, tuple)):
                raise JsonSchemaValueException((*path, 'atoms'), 'type', 'array')
            data__atoms_is_list = isinstance(data__atoms, (list, tuple))
            if data__atoms_is_list:
                data__atoms_len = len(data__atoms)
                for data__atoms_x, data__atoms_item in enumerate(data__atoms):
                    if not isinstance(data__atoms_item, (dict)):
                        raise JsonSchemaValueException((*path, 'atoms', data__atoms_x), 'type', 'object')
                    data__atoms_item_is_dict = isinstance(data__atoms_item, dict)
                    if data__atoms_item_is_dict:
                        data__atoms_item__missing_keys = set(['name', 'expression']) - data__atoms_item.keys()
                        if data__atoms_item__missing_keys:
                            raise JsonSchemaValueException((*path, 'atoms', data__atoms_x), 'required', ['name', 'expression'], sorted(data__atoms_item__missing_keys))
                        data__atoms_item_keys = set(data__atoms_item.keys())
                        if "name" in data__atoms_item_keys:
                            data__atoms_item_keys.remove("name")
                            data__atoms_item__name = data__atoms_item["name"]
                            if not isinstance(data__atoms_item__name, (str)):
                                raise JsonSchemaValueException((*path, 'atoms', data__atoms_x, 'name'), 'type', 'string')
                            if isinstance(data__atoms_item__name, str):
                                data__atoms_item__name_len = len(data__atoms_item__name)
                                if data__atoms_item__name_len < 1:
                                    raise JsonSchemaValueException((*path, 'atoms', data__atoms_x, 'name'), 'minLength', 1)
                        if "expression" in data__atoms_item_keys:
                            data__atoms_item_keys.remove("expression")
                            data__atoms_item__expression = data__atoms_item["expression"]
                            validate___definitions_expression(data__atoms_item__expression, custom_formats, (*path, 'atoms', data__atoms_x, 'expression'))
                        if "timer" in data__atoms_item_keys:
                            data__atoms_item_keys.remove("timer")
                            data__atoms_item__timer = data__atoms_item["timer"]
                            if not isinstance(data__atoms_item__timer, (dict)):
                                raise JsonSchemaValueException((*path, 'atoms', data__atoms_x, 'timer'), 'type', 'object')
                            data__atoms_item__timer_is_dict = isinstance(data__atoms_item__timer, dict)
                            if data__atoms_item__timer_is_dict:
                                data__atoms_item__timer_keys = set(data__atoms_item__timer.keys())
                                if "later" in data__atoms_item__timer_keys:
                                    data__atoms_item__timer_keys.remove("later")
                                    data__atoms_item__timer__later = data__atoms_item__timer["later"]
                                    if not isinstance(data__atoms_item__timer__later, (list, tuple)):
                                        raise JsonSchemaValueException((*path, 'atoms', data__atoms_x, 'timer', 'later'), 'type', 'array')
                                    data__atoms_item__timer__later_is_list = isinstance(data__atoms_item__timer__later, (list, tuple))
                                    if data__atoms_item__timer__later_is_list:
                                        data__atoms_item__timer__later_len = len(data__atoms_item__timer__later)
                                        for data__atoms_item__timer__later_x, data__atoms_item__timer__later_item in enumerate(data__atoms_item__timer__later):
                                            if not isinstance(data__atoms_item__timer__later_item, (bool)):
                                                raise JsonSchemaValueException((*path, 'atoms', data__atoms_x, 'timer', 'later', data__atoms_item__timer__later_x), 'type', 'boolean')
                        if "doc" in data__atoms_item_keys:
                            data__atoms_item_keys.remove("doc")
                            data__atoms_item__doc = data__atoms_item["doc"]
                            if not isinstance(data__atoms_item__doc, (str)):
                                raise JsonSchemaValueException((*path, 'atoms', data__atoms_x, 'doc'), 'type', 'string')
        if "registers" in data_keys:
            data_keys.remove("registers")
            data__registers = data["registers"]
            if not isinstance(data__registers, (list, tuple)):
                raise JsonSchemaValueException((*path, 'registers'), 'type', 'array')
            data__registers_is_list = isinstance(data__registers, (list, tuple))
            if data__registers_is_list:
                data__registers_len = len(data__registers)
                for data__registers_x, data__registers_item in enumerate(data__registers):
                    if not isinstance(data__registers_item, (dict)):
                        raise JsonSchemaValueException((*path, 'registers', data__registers_x), 'type', 'object')
                    data__registers_item_is_dict = isinstance(data__registers_item, dict)
                    if data__registers_item_is_dict:
                        data__registers_item__missing_keys = set(['name', 'kind', 'unit', 'range', 'initial', 'update']) - data__registers_item.keys()
                        if data__registers_item__missing_keys:
                            raise JsonSchemaValueException((*path, 'registers', data__registers_x), 'required', ['name', 'kind', 'unit', 'range', 'initial', 'update'], sorted(data__registers_item__missing_keys))
                        data__registers_item_keys = set(data__registers_item.keys())
                        if "name" in data__registers_item_keys:
                            data__registers_item_keys.remove("name")
                            data__registers_item__name = data__registers_item["name"]
                            if not isinstance(data__registers_item__name, (str)):
                                raise JsonSchemaValueException((*path, 'registers', data__registers_x, 'name'), 'type', 'string')
                            if isinstance(data__registers_item__name, str):
                                data__registers_item__name_len = len(data__registers_item__name)
                                if data__registers_item__name_len < 1:
                                    raise JsonSchemaValueException((*path, 'registers', data__registers_x, 'name'), 'minLength', 1)
                        if "kind" in data__registers_item_keys:
                            data__registers_item_keys.remove("kind")
                            data__registers_item__kind = data__registers_item["kind"]
                            if not (isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'once' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'historically' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'since' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'previously' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'times' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'time_since' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'time_holding' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'times_since' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'total_time' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'total_time_since' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'times_within' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'begun' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'previous' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'initial' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'highest' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'lowest' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'highest_since' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'lowest_since' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'value_at' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'samples' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'elapsed' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'run' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'age' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'due' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'waiting' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'breach' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'last' or isinstance(data__registers_item__kind, str) and data__registers_item__kind == 'first'):
                                raise JsonSchemaValueException((*path, 'registers', data__registers_x, 'kind'), 'enum', ['once', 'historically', 'since', 'previously', 'times', 'time_since', 'time_holding', 'times_since', 'total_time', 'total_time_since', 'times_within', 'begun', 'previous', 'initial', 'highest', 'lowest', 'highest_since', 'lowest_since', 'value_at', 'samples', 'elapsed', 'run', 'age', 'due', 'waiting', 'breach', 'last', 'first'])
                        if "unit" in data__registers_item_keys:
                            data__registers_item_keys.remove("unit")
                            data__registers_item__unit = data__registers_item["unit"]
                            if not isinstance(data__registers_item__unit, (str)):
                                raise JsonSchemaValueException((*path, 'registers', data__registers_x, 'unit'), 'type', 'string')
                        if "range" in data__registers_item_keys:
                            data__registers_item_keys.remove("range")
                            data__registers_item__range = data__registers_item["range"]
                            if not isinstance(data__registers_item__range, (list, tuple)):
                                raise JsonSchemaValueException((*path, 'registers', data__registers_x, 'range'), 'type', 'array')
                            data__registers_item__range_is_list = isinstance(data__registers_item__range, (list, tuple))
                            if data__registers_item__range_is_list:
                                data__registers_item__range_len = len(data__registers_item__range)
                                if data__registers_item__range_len < 2:
                                    raise JsonSchemaValueException((*path, 'registers', data__registers_x, 'range'), 'minItems', 2)
                                if data__registers_item__range_len > 2:
                                    raise JsonSchemaValueException((*path, 'registers', data__registers_x, 'range'), 'maxItems', 2)
                                for data__registers_item__range_x, data__registers_item__range_item in enumerate(data__registers_item__range):
                                    if not isinstance(data__registers_item__range_item, (int, float, NoneType)) or isinstance(data__registers_item__range_item, bool):
                                        raise JsonSchemaValueException((*path, 'registers', data__registers_x, 'range', data__registers_item__range_x), 'type', ['number', 'null'])
                                    if isinstance(data__registers_item__range_item, (int, float)) and not isinstance(data__registers_item__range_item, bool):
                                        if data__registers_item__range_item < -1.7976931348623157e+308:
                                            raise JsonSchemaValueException((*path, 'registers', data__registers_x, 'range', data__registers_item__range_x), 'minimum', -1.7976931348623157e+308)
                                        if data__registers_item__range_item > 1.7976931348623157e+308:
                                            raise JsonSchemaValueException((*path, 'registers', data__registers_x, 'range', data__registers_item__range_x), 'maximum', 1.7976931348623157e+308)
                        if "initial" in data__registers_item_keys:
                            data__registers_item_keys.remove("initial")
                            data__registers_item__initial = data__registers_item["initial"]
                            if not isinstance(data__registers_item__initial, (int, float)) or isinstance(data__registers_item__initial, bool):
                                raise JsonSchemaValueException((*path, 'registers', data__registers_x, 'initial'), 'type', 'number')
                            if isinstance(data__registers_item__initial, (int, float)) and not isinstance(data__registers_item__initial, bool):
                                if data__registers_item__initial < -1.7976931348623157e+308:
                                    raise JsonSchemaValueException((*path, 'registers', data__registers_x, 'initial'), 'minimum', -1.7976931348623157e+308)
                                if data__registers_item__initial > 1.7976931348623157e+308:
                                    raise JsonSchemaValueException((*path, 'registers', data__registers_x, 'initial'), 'maximum', 1.7976931348623157e+308)
                        if "update" in data__registers_item_keys:
                            data__registers_item_keys.remove("update")
                            data__registers_item__update = data__registers_item["update"]
                            validate___definitions_expression(data__registers_item__update, custom_formats, (*path, 'registers', data__registers_x, 'update'))
        if "exclusive" in data_keys:
            data_keys.remove("exclusive")
            data__exclusive = data["exclusive"]
            if not isinstance(data__exclusive, (list, tuple)):
                raise JsonSchemaValueException((*path, 'exclusive'), 'type', 'array')
            data__exclusive_is_list = isinstance(data__exclusive, (list, tuple))
            if data__exclusive_is_list:
                data__exclusive_len = len(data__exclusive)
                for data__exclusive_x, data__exclusive_item in enumerate(data__exclusive):
                    if not isinstance(data__exclusive_item, (list, tuple)):
                        raise JsonSchemaValueException((*path, 'exclusive', data__exclusive_x), 'type', 'array')
                    data__exclusive_item_is_list = isinstance(data__exclusive_item, (list, tuple))
                    if data__exclusive_item_is_list:
                        data__exclusive_item_len = len(data__exclusive_item)
                        if data__exclusive_item_len < 2:
                            raise JsonSchemaValueException((*path, 'exclusive', data__exclusive_x), 'minItems', 2)
                        def fn(var): return frozenset(dict((k, fn(v)) for k, v in var.items()).items()) if hasattr(var, "items") else tuple(fn(v) for v in var) if isinstance(var, (dict, list)) else (bool, var) if isinstance(var, bool) else var
                        if data__exclusive_item_len > len(set(fn(data__exclusive_item_x) for data__exclusive_item_x in data__exclusive_item)):
                            raise JsonSchemaValueException((*path, 'exclusive', data__exclusive_x), 'uniqueItems', True)
                        for data__exclusive_item_x, data__exclusive_item_item in enumerate(data__exclusive_item):
                            if not isinstance(data__exclusive_item_item, (int)) and not (isinstance(data__exclusive_item_item, float) and data__exclusive_item_item.is_integer()) or isinstance(data__exclusive_item_item, bool):
                                raise JsonSchemaValueException((*path, 'exclusive', data__exclusive_x, data__exclusive_item_x), 'type', 'integer')
                            if isinstance(data__exclusive_item_item, (int, float)) and not isinstance(data__exclusive_item_item, bool):
                                if data__exclusive_item_item < 0:
                                    raise JsonSchemaValueException((*path, 'exclusive', data__exclusive_x, data__exclusive_item_x), 'minimum', 0)
        if "states" in data_keys:
            data_keys.remove("states")
            data__states = data["states"]
            if not isinstance(data__states, (list, tuple)):
                raise JsonSchemaValueException((*path, 'states'), 'type', 'array')
            data__states_is_list = isinstance(data__states, (list, tuple))
            if data__states_is_list:
                data__states_len = len(data__states)
                if data__states_len < 1:
                    raise JsonSchemaValueException((*path, 'states'), 'minItems', 1)
                for data__states_x, data__states_item in enumerate(data__states):
                    if not isinstance(data__states_item, (dict)):
                        raise JsonSchemaValueException((*path, 'states', data__states_x), 'type', 'object')
                    data__states_item_is_dict = isinstance(data__states_item, dict)
                    if data__states_item_is_dict:
                        data__states_item__missing_keys = set(['id', 'label', 'accepting', 'verdict', 'distance']) - data__states_item.keys()
                        if data__states_item__missing_keys:
                            raise JsonSchemaValueException((*path, 'states', data__states_x), 'required', ['id', 'label', 'accepting', 'verdict', 'distance'], sorted(data__states_item__missing_keys))
                        data__states_item_keys = set(data__states_item.keys())
                        if "id" in data__states_item_keys:
                            data__states_item_keys.remove("id")
                            data__states_item__id = data__states_item["id"]
                            if not isinstance(data__states_item__id, (int)) and not (isinstance(data__states_item__id, float) and data__states_item__id.is_integer()) or isinstance(data__states_item__id, bool):
                                raise JsonSchemaValueException((*path, 'states', data__states_x, 'id'), 'type', 'integer')
                            if isinstance(data__states_item__id, (int, float)) and not isinstance(data__states_item__id, bool):
                                if data__states_item__id < 0:
                                    raise JsonSchemaValueException((*path, 'states', data__states_x, 'id'), 'minimum', 0)
                        if "label" in data__states_item_keys:
                            data__states_item_keys.remove("label")
                            data__states_item__label = data__states_item["label"]
                            if not isinstance(data__states_item__label, (dict)):
                                raise JsonSchemaValueException((*path, 'states', data__states_x, 'label'), 'type', 'object')
                            data__states_item__label_is_dict = isinstance(data__states_item__label, dict)
                            if data__states_item__label_is_dict:
                                data__states_item__label__missing_keys = set(['ascii', 'unicode', 'english']) - data__states_item__label.keys()
                                if data__states_item__label__missing_keys:
                                    raise JsonSchemaValueException((*path, 'states', data__states_x, 'label'), 'required', ['ascii', 'unicode', 'english'], sorted(data__states_item__label__missing_keys))
                                data__states_item__label_keys = set(data__states_item__label.keys())
                                if "ascii" in data__states_item__label_keys:
                                    data__states_item__label_keys.remove("ascii")
                                    data__states_item__label__ascii = data__states_item__label["ascii"]
                                    if not isinstance(data__states_item__label__ascii, (str)):
                                        raise JsonSchemaValueException((*path, 'states', data__states_x, 'label', 'ascii'), 'type', 'string')
                                if "unicode" in data__states_item__label_keys:
                                    data__states_item__label_keys.remove("unicode")
                                    data__states_item__label__unicode = data__states_item__label["unicode"]
                                    if not isinstance(data__states_item__label__unicode, (str)):
                                        raise JsonSchemaValueException((*path, 'states', data__states_x, 'label', 'unicode'), 'type', 'string')
                                if "english" in data__states_item__label_keys:
                                    data__states_item__label_keys.remove("english")
                                    data__states_item__label__english = data__states_item__label["english"]
                                    if not isinstance(data__states_item__label__english, (str)):
                                        raise JsonSchemaValueException((*path, 'states', data__states_x, 'label', 'english'), 'type', 'string')
                        if "accepting" in data__states_item_keys:
                            data__states_item_keys.remove("accepting")
                            data__states_item__accepting = data__states_item["accepting"]
                            if not isinstance(data__states_item__accepting, (bool)):
                                raise JsonSchemaValueException((*path, 'states', data__states_x, 'accepting'), 'type', 'boolean')
                        if "verdict" in data__states_item_keys:
                            data__states_item_keys.remove("verdict")
                            data__states_item__verdict = data__states_item["verdict"]
                            if not (isinstance(data__states_item__verdict, str) and data__states_item__verdict == 'satisfied' or isinstance(data__states_item__verdict, str) and data__states_item__verdict == 'holding' or isinstance(data__states_item__verdict, str) and data__states_item__verdict == 'pending' or isinstance(data__states_item__verdict, str) and data__states_item__verdict == 'violated'):
                                raise JsonSchemaValueException((*path, 'states', data__states_x, 'verdict'), 'enum', ['satisfied', 'holding', 'pending', 'violated'])
                        if "distance" in data__states_item_keys:
                            data__states_item_keys.remove("distance")
                            data__states_item__distance = data__states_item["distance"]
                            if not isinstance(data__states_item__distance, (int, NoneType)) and not (isinstance(data__states_item__distance, float) and data__states_item__distance.is_integer()) or isinstance(data__states_item__distance, bool):
                                raise JsonSchemaValueException((*path, 'states', data__states_x, 'distance'), 'type', ['integer', 'null'])
                            if isinstance(data__states_item__distance, (int, float)) and not isinstance(data__states_item__distance, bool):
                                if data__states_item__distance < 0:
                                    raise JsonSchemaValueException((*path, 'states', data__states_x, 'distance'), 'minimum', 0)
        if "initial" in data_keys:
            data_keys.remove("initial")
            data__initial = data["initial"]
            if not (isinstance(data__initial, (int, float)) and not isinstance(data__initial, bool) and data__initial == 0):
                raise JsonSchemaValueException((*path, 'initial'), 'enum', [0])
        if "edges" in data_keys:
            data_keys.remove("edges")
            data__edges = data["edges"]
            if not isinstance(data__edges, (list, tuple)):
                raise JsonSchemaValueException((*path, 'edges'), 'type', 'array')
            data__edges_is_list = isinstance(data__edges, (list, tuple))
            if data__edges_is_list:
                data__edges_len = len(data__edges)
                for data__edges_x, data__edges_item in enumerate(data__edges):
                    if not isinstance(data__edges_item, (dict)):
                        raise JsonSchemaValueException((*path, 'edges', data__edges_x), 'type', 'object')
                    data__edges_item_is_dict = isinstance(data__edges_item, dict)
                    if data__edges_item_is_dict:
                        data__edges_item__missing_keys = set(['source', 'target', 'guard']) - data__edges_item.keys()
                        if data__edges_item__missing_keys:
                            raise JsonSchemaValueException((*path, 'edges', data__edges_x), 'required', ['source', 'target', 'guard'], sorted(data__edges_item__missing_keys))
                        data__edges_item_keys = set(data__edges_item.keys())
                        if "source" in data__edges_item_keys:
                            data__edges_item_keys.remove("source")
                            data__edges_item__source = data__edges_item["source"]
                            if not isinstance(data__edges_item__source, (int)) and not (isinstance(data__edges_item__source, float) and data__edges_item__source.is_integer()) or isinstance(data__edges_item__source, bool):
                                raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'source'), 'type', 'integer')
                            if isinstance(data__edges_item__source, (int, float)) and not isinstance(data__edges_item__source, bool):
                                if data__edges_item__source < 0:
                                    raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'source'), 'minimum', 0)
                        if "target" in data__edges_item_keys:
                            data__edges_item_keys.remove("target")
                            data__edges_item__target = data__edges_item["target"]
                            if not isinstance(data__edges_item__target, (int)) and not (isinstance(data__edges_item__target, float) and data__edges_item__target.is_integer()) or isinstance(data__edges_item__target, bool):
                                raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'target'), 'type', 'integer')
                            if isinstance(data__edges_item__target, (int, float)) and not isinstance(data__edges_item__target, bool):
                                if data__edges_item__target < 0:
                                    raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'target'), 'minimum', 0)
                        if "guard" in data__edges_item_keys:
                            data__edges_item_keys.remove("guard")
                            data__edges_item__guard = data__edges_item["guard"]
                            if not isinstance(data__edges_item__guard, (dict)):
                                raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'guard'), 'type', 'object')
                            data__edges_item__guard_is_dict = isinstance(data__edges_item__guard, dict)
                            if data__edges_item__guard_is_dict:
                                data__edges_item__guard__missing_keys = set(['text', 'primes']) - data__edges_item__guard.keys()
                                if data__edges_item__guard__missing_keys:
                                    raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'guard'), 'required', ['text', 'primes'], sorted(data__edges_item__guard__missing_keys))
                                data__edges_item__guard_keys = set(data__edges_item__guard.keys())
                                if "text" in data__edges_item__guard_keys:
                                    data__edges_item__guard_keys.remove("text")
                                    data__edges_item__guard__text = data__edges_item__guard["text"]
                                    if not isinstance(data__edges_item__guard__text, (str)):
                                        raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'guard', 'text'), 'type', 'string')
                                if "primes" in data__edges_item__guard_keys:
                                    data__edges_item__guard_keys.remove("primes")
                                    data__edges_item__guard__primes = data__edges_item__guard["primes"]
                                    if not isinstance(data__edges_item__guard__primes, (list, tuple)):
                                        raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'guard', 'primes'), 'type', 'array')
                                    data__edges_item__guard__primes_is_list = isinstance(data__edges_item__guard__primes, (list, tuple))
                                    if data__edges_item__guard__primes_is_list:
                                        data__edges_item__guard__primes_len = len(data__edges_item__guard__primes)
                                        if data__edges_item__guard__primes_len < 1:
                                            raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'guard', 'primes'), 'minItems', 1)
                                        for data__edges_item__guard__primes_x, data__edges_item__guard__primes_item in enumerate(data__edges_item__guard__primes):
                                            if not isinstance(data__edges_item__guard__primes_item, (list, tuple)):
                                                raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'guard', 'primes', data__edges_item__guard__primes_x), 'type', 'array')
                                            data__edges_item__guard__primes_item_is_list = isinstance(data__edges_item__guard__primes_item, (list, tuple))
                                            if data__edges_item__guard__primes_item_is_list:
                                                data__edges_item__guard__primes_item_len = len(data__edges_item__guard__primes_item)
                                                for data__edges_item__guard__primes_item_x, data__edges_item__guard__primes_item_item in enumerate(data__edges_item__guard__primes_item):
                                                    if not isinstance(data__edges_item__guard__primes_item_item, (list, tuple)):
                                                        raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'guard', 'primes', data__edges_item__guard__primes_x, data__edges_item__guard__primes_item_x), 'type', 'array')
                                                    data__edges_item__guard__primes_item_item_is_list = isinstance(data__edges_item__guard__primes_item_item, (list, tuple))
                                                    if data__edges_item__guard__primes_item_item_is_list:
                                                        data__edges_item__guard__primes_item_item_len = len(data__edges_item__guard__primes_item_item)
                                                        if data__edges_item__guard__primes_item_item_len < 2:
                                                            raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'guard', 'primes', data__edges_item__guard__primes_x, data__edges_item__guard__primes_item_x), 'minItems', 2)
                                                        if data__edges_item__guard__primes_item_item_len > 2:
                                                            raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'guard', 'primes', data__edges_item__guard__primes_x, data__edges_item__guard__primes_item_x), 'maxItems', 2)
                                                        if data__edges_item__guard__primes_item_item_len > 0:
                                                            data__edges_item__guard__primes_item_item__0 = data__edges_item__guard__primes_item_item[0]
                                                            if not isinstance(data__edges_item__guard__primes_item_item__0, (int)) and not (isinstance(data__edges_item__guard__primes_item_item__0, float) and data__edges_item__guard__primes_item_item__0.is_integer()) or isinstance(data__edges_item__guard__primes_item_item__0, bool):
                                                                raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'guard', 'primes', data__edges_item__guard__primes_x, data__edges_item__guard__primes_item_x, 0), 'type', 'integer')
                                                            if isinstance(data__edges_item__guard__primes_item_item__0, (int, float)) and not isinstance(data__edges_item__guard__primes_item_item__0, bool):
                                                                if data__edges_item__guard__primes_item_item__0 < 0:
                                                                    raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'guard', 'primes', data__edges_item__guard__primes_x, data__edges_item__guard__primes_item_x, 0), 'minimum', 0)
                                                        if data__edges_item__guard__primes_item_item_len > 1:
                                                            data__edges_item__guard__primes_item_item__1 = data__edges_item__guard__primes_item_item[1]
                                                            if not isinstance(data__edges_item__guard__primes_item_item__1, (bool)):
                                                                raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'guard', 'primes', data__edges_item__guard__primes_x, data__edges_item__guard__primes_item_x, 1), 'type', 'boolean')
                        if "broken" in data__edges_item_keys:
                            data__edges_item_keys.remove("broken")
                            data__edges_item__broken = data__edges_item["broken"]
                            if not isinstance(data__edges_item__broken, (list, tuple)):
                                raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'broken'), 'type', 'array')
                            data__edges_item__broken_is_list = isinstance(data__edges_item__broken, (list, tuple))
                            if data__edges_item__broken_is_list:
                                data__edges_item__broken_len = len(data__edges_item__broken)
                                for data__edges_item__broken_x, data__edges_item__broken_item in enumerate(data__edges_item__broken):
                                    if not isinstance(data__edges_item__broken_item, (dict)):
                                        raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'broken', data__edges_item__broken_x), 'type', 'object')
                                    data__edges_item__broken_item_is_dict = isinstance(data__edges_item__broken_item, dict)
                                    if data__edges_item__broken_item_is_dict:
                                        data__edges_item__broken_item__missing_keys = set(['clause']) - data__edges_item__broken_item.keys()
                                        if data__edges_item__broken_item__missing_keys:
                                            raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'broken', data__edges_item__broken_x), 'required', ['clause'], sorted(data__edges_item__broken_item__missing_keys))
                                        data__edges_item__broken_item_keys = set(data__edges_item__broken_item.keys())
                                        if "clause" in data__edges_item__broken_item_keys:
                                            data__edges_item__broken_item_keys.remove("clause")
                                            data__edges_item__broken_item__clause = data__edges_item__broken_item["clause"]
                                            if not isinstance(data__edges_item__broken_item__clause, (int)) and not (isinstance(data__edges_item__broken_item__clause, float) and data__edges_item__broken_item__clause.is_integer()) or isinstance(data__edges_item__broken_item__clause, bool):
                                                raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'broken', data__edges_item__broken_x, 'clause'), 'type', 'integer')
                                            if isinstance(data__edges_item__broken_item__clause, (int, float)) and not isinstance(data__edges_item__broken_item__clause, bool):
                                                if data__edges_item__broken_item__clause < 0:
                                                    raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'broken', data__edges_item__broken_x, 'clause'), 'minimum', 0)
                                        if "primes" in data__edges_item__broken_item_keys:
                                            data__edges_item__broken_item_keys.remove("primes")
                                            data__edges_item__broken_item__primes = data__edges_item__broken_item["primes"]
                                            if not isinstance(data__edges_item__broken_item__primes, (list, tuple)):
                                                raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'broken', data__edges_item__broken_x, 'primes'), 'type', 'array')
                                            data__edges_item__broken_item__primes_is_list = isinstance(data__edges_item__broken_item__primes, (list, tuple))
                                            if data__edges_item__broken_item__primes_is_list:
                                                data__edges_item__broken_item__primes_len = len(data__edges_item__broken_item__primes)
                                                if data__edges_item__broken_item__primes_len < 1:
                                                    raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'broken', data__edges_item__broken_x, 'primes'), 'minItems', 1)
                                                for data__edges_item__broken_item__primes_x, data__edges_item__broken_item__primes_item in enumerate(data__edges_item__broken_item__primes):
                                                    if not isinstance(data__edges_item__broken_item__primes_item, (list, tuple)):
                                                        raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'broken', data__edges_item__broken_x, 'primes', data__edges_item__broken_item__primes_x), 'type', 'array')
                                                    data__edges_item__broken_item__primes_item_is_list = isinstance(data__edges_item__broken_item__primes_item, (list, tuple))
                                                    if data__edges_item__broken_item__primes_item_is_list:
                                                        data__edges_item__broken_item__primes_item_len = len(data__edges_item__broken_item__primes_item)
                                                        for data__edges_item__broken_item__primes_item_x, data__edges_item__broken_item__primes_item_item in enumerate(data__edges_item__broken_item__primes_item):
                                                            if not isinstance(data__edges_item__broken_item__primes_item_item, (list, tuple)):
                                                                raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'broken', data__edges_item__broken_x, 'primes', data__edges_item__broken_item__primes_x, data__edges_item__broken_item__primes_item_x), 'type', 'array')
                                                            data__edges_item__broken_item__primes_item_item_is_list = isinstance(data__edges_item__broken_item__primes_item_item, (list, tuple))
                                                            if data__edges_item__broken_item__primes_item_item_is_list:
                                                                data__edges_item__broken_item__primes_item_item_len = len(data__edges_item__broken_item__primes_item_item)
                                                                if data__edges_item__broken_item__primes_item_item_len < 2:
                                                                    raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'broken', data__edges_item__broken_x, 'primes', data__edges_item__broken_item__primes_x, data__edges_item__broken_item__primes_item_x), 'minItems', 2)
                                                                if data__edges_item__broken_item__primes_item_item_len > 2:
                                                                    raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'broken', data__edges_item__broken_x, 'primes', data__edges_item__broken_item__primes_x, data__edges_item__broken_item__primes_item_x), 'maxItems', 2)
                                                                if data__edges_item__broken_item__primes_item_item_len > 0:
                                                                    data__edges_item__broken_item__primes_item_item__0 = data__edges_item__broken_item__primes_item_item[0]
                                                                    if not isinstance(data__edges_item__broken_item__primes_item_item__0, (int)) and not (isinstance(data__edges_item__broken_item__primes_item_item__0, float) and data__edges_item__broken_item__primes_item_item__0.is_integer()) or isinstance(data__edges_item__broken_item__primes_item_item__0, bool):
                                                                        raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'broken', data__edges_item__broken_x, 'primes', data__edges_item__broken_item__primes_x, data__edges_item__broken_item__primes_item_x, 0), 'type', 'integer')
                                                                    if isinstance(data__edges_item__broken_item__primes_item_item__0, (int, float)) and not isinstance(data__edges_item__broken_item__primes_item_item__0, bool):
                                                                        if data__edges_item__broken_item__primes_item_item__0 < 0:
                                                                            raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'broken', data__edges_item__broken_x, 'primes', data__edges_item__broken_item__primes_x, data__edges_item__broken_item__primes_item_x, 0), 'minimum', 0)
                                                                if data__edges_item__broken_item__primes_item_item_len > 1:
                                                                    data__edges_item__broken_item__primes_item_item__1 = data__edges_item__broken_item__primes_item_item[1]
                                                                    if not isinstance(data__edges_item__broken_item__primes_item_item__1, (bool)):
                                                                        raise JsonSchemaValueException((*path, 'edges', data__edges_x, 'broken', data__edges_item__broken_x, 'primes', data__edges_item__broken_item__primes_x, data__edges_item__broken_item__primes_item_x, 1), 'type', 'boolean')
        if "spec_size" in data_keys:
            data_keys.remove("spec_size")
            data__specsize = data["spec_size"]
            if not isinstance(data__specsize, (int)) and not (isinstance(data__specsize, float) and data__specsize.is_integer()) or isinstance(data__specsize, bool):
                raise JsonSchemaValueException((*path, 'spec_size'), 'type', 'integer')
            if isinstance(data__specsize, (int, float)) and not isinstance(data__specsize, bool):
                if data__specsize < 0:
                    raise JsonSchemaValueException((*path, 'spec_size'), 'minimum', 0)
        if "acceptance" in data_keys:
            data_keys.remove("acceptance")
            data__acceptance = data["acceptance"]
            if not isinstance(data__acceptance, (dict)):
                raise JsonSchemaValueException((*path, 'acceptance'), 'type', 'object')
            data__acceptance_is_dict = isinstance(data__acceptance, dict)
            if data__acceptance_is_dict:
                data__acceptance__missing_keys = set(['pairs']) - data__acceptance.keys()
                if data__acceptance__missing_keys:
                    raise JsonSchemaValueException((*path, 'acceptance'), 'required', ['pairs'], sorted(data__acceptance__missing_keys))
                data__acceptance_keys = set(data__acceptance.keys())
                if "pairs" in data__acceptance_keys:
                    data__acceptance_keys.remove("pairs")
                    data__acceptance__pairs = data__acceptance["pairs"]
                    if not isinstance(data__acceptance__pairs, (list, tuple)):
                        raise JsonSchemaValueException((*path, 'acceptance', 'pairs'), 'type', 'array')
                    data__acceptance__pairs_is_list = isinstance(data__acceptance__pairs, (list, tuple))
                    if data__acceptance__pairs_is_list:
                        data__acceptance__pairs_len = len(data__acceptance__pairs)
                        for data__acceptance__pairs_x, data__acceptance__pairs_item in enumerate(data__acceptance__pairs):
                            if not isinstance(data__acceptance__pairs_item, (dict)):
                                raise JsonSchemaValueException((*path, 'acceptance', 'pairs', data__acceptance__pairs_x), 'type', 'object')
                            data__acceptance__pairs_item_is_dict = isinstance(data__acceptance__pairs_item, dict)
                            if data__acceptance__pairs_item_is_dict:
                                data__acceptance__pairs_item__missing_keys = set(['fin', 'inf']) - data__acceptance__pairs_item.keys()
                                if data__acceptance__pairs_item__missing_keys:
                                    raise JsonSchemaValueException((*path, 'acceptance', 'pairs', data__acceptance__pairs_x), 'required', ['fin', 'inf'], sorted(data__acceptance__pairs_item__missing_keys))
                                data__acceptance__pairs_item_keys = set(data__acceptance__pairs_item.keys())
                                if "fin" in data__acceptance__pairs_item_keys:
                                    data__acceptance__pairs_item_keys.remove("fin")
                                    data__acceptance__pairs_item__fin = data__acceptance__pairs_item["fin"]
                                    if not isinstance(data__acceptance__pairs_item__fin, (list, tuple)):
                                        raise JsonSchemaValueException((*path, 'acceptance', 'pairs', data__acceptance__pairs_x, 'fin'), 'type', 'array')
                                    data__acceptance__pairs_item__fin_is_list = isinstance(data__acceptance__pairs_item__fin, (list, tuple))
                                    if data__acceptance__pairs_item__fin_is_list:
                                        data__acceptance__pairs_item__fin_len = len(data__acceptance__pairs_item__fin)
                                        for data__acceptance__pairs_item__fin_x, data__acceptance__pairs_item__fin_item in enumerate(data__acceptance__pairs_item__fin):
                                            if not isinstance(data__acceptance__pairs_item__fin_item, (int)) and not (isinstance(data__acceptance__pairs_item__fin_item, float) and data__acceptance__pairs_item__fin_item.is_integer()) or isinstance(data__acceptance__pairs_item__fin_item, bool):
                                                raise JsonSchemaValueException((*path, 'acceptance', 'pairs', data__acceptance__pairs_x, 'fin', data__acceptance__pairs_item__fin_x), 'type', 'integer')
                                            if isinstance(data__acceptance__pairs_item__fin_item, (int, float)) and not isinstance(data__acceptance__pairs_item__fin_item, bool):
                                                if data__acceptance__pairs_item__fin_item < 0:
                                                    raise JsonSchemaValueException((*path, 'acceptance', 'pairs', data__acceptance__pairs_x, 'fin', data__acceptance__pairs_item__fin_x), 'minimum', 0)
                                if "inf" in data__acceptance__pairs_item_keys:
                                    data__acceptance__pairs_item_keys.remove("inf")
                                    data__acceptance__pairs_item__inf = data__acceptance__pairs_item["inf"]
                                    if not isinstance(data__acceptance__pairs_item__inf, (list, tuple)):
                                        raise JsonSchemaValueException((*path, 'acceptance', 'pairs', data__acceptance__pairs_x, 'inf'), 'type', 'array')
                                    data__acceptance__pairs_item__inf_is_list = isinstance(data__acceptance__pairs_item__inf, (list, tuple))
                                    if data__acceptance__pairs_item__inf_is_list:
                                        data__acceptance__pairs_item__inf_len = len(data__acceptance__pairs_item__inf)
                                        for data__acceptance__pairs_item__inf_x, data__acceptance__pairs_item__inf_item in enumerate(data__acceptance__pairs_item__inf):
                                            if not isinstance(data__acceptance__pairs_item__inf_item, (int)) and not (isinstance(data__acceptance__pairs_item__inf_item, float) and data__acceptance__pairs_item__inf_item.is_integer()) or isinstance(data__acceptance__pairs_item__inf_item, bool):
                                                raise JsonSchemaValueException((*path, 'acceptance', 'pairs', data__acceptance__pairs_x, 'inf', data__acceptance__pairs_item__inf_x), 'type', 'integer')
                                            if isinstance(data__acceptance__pairs_item__inf_item, (int, float)) and not isinstance(data__acceptance__pairs_item__inf_item, bool):
                                                if data__acceptance__pairs_item__inf_item < 0:
                                                    raise JsonSchemaValueException((*path, 'acceptance', 'pairs', data__acceptance__pairs_x, 'inf', data__acceptance__pairs_item__inf_x), 'minimum', 0)
    try:
        data_is_dict = isinstance(data, dict)
        if data_is_dict:
            data__missing_keys = set(['semantics']) - data.keys()
            if data__missing_keys:
                raise JsonSchemaValueException(path, 'required', ['semantics'], sorted(data__missing_keys))
            data_keys = set(data.keys())
            if "semantics" in data_keys:
                data_keys.remove("semantics")
                data__semantics = data["semantics"]
                if not (isinstance(data__semantics, str) and data__semantics == 'infinite'):
                    raise JsonSchemaValueException((*path, 'semantics'), 'enum', ['infinite'])
    except JsonSchemaValueException:
        pass
    else:
        data_is_dict = isinstance(data, dict)
        if data_is_dict:
            data__missing_keys = set(['acceptance']) - data.keys()
            if data__missing_keys:
                raise JsonSchemaValueException(path, 'required', ['acceptance'], sorted(data__missing_keys))
    return data

def validate___definitions_expression(data: object, custom_formats: object = {}, path: JsonPath = ()) -> object:
    if not isinstance(data, (dict)):
        raise JsonSchemaValueException(path, 'type', 'object')
    try:
        data_is_dict = isinstance(data, dict)
        if data_is_dict:
            data__missing_keys = set(['op']) - data.keys()
            if data__missing_keys:
                raise JsonSchemaValueException(path, 'required', ['op'], sorted(data__missing_keys))
            data_keys = set(data.keys())
            if "op" in data_keys:
                data_keys.remove("op")
                data__op = data["op"]
                if not (isinstance(data__op, str) and data__op == '+' or isinstance(data__op, str) and data__op == '-' or isinstance(data__op, str) and data__op == '*' or isinstance(data__op, str) and data__op == '/' or isinstance(data__op, str) and data__op == '^'):
                    raise JsonSchemaValueException((*path, 'op'), 'enum', ['+', '-', '*', '/', '^'])
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
                        raise JsonSchemaValueException((*path, 'args'), 'minItems', 2)
                    if data__args_len > 2:
                        raise JsonSchemaValueException((*path, 'args'), 'maxItems', 2)
    try:
        data_is_dict = isinstance(data, dict)
        if data_is_dict:
            data__missing_keys = set(['op']) - data.keys()
            if data__missing_keys:
                raise JsonSchemaValueException(path, 'required', ['op'], sorted(data__missing_keys))
            data_keys = set(data.keys())
            if "op" in data_keys:
                data_keys.remove("op")
                data__op = data["op"]
                if not (isinstance(data__op, str) and data__op == 'neg' or isinstance(data__op, str) and data__op == 'abs' or isinstance(data__op, str) and data__op == 'sqrt' or isinstance(data__op, str) and data__op == 'exp' or isinstance(data__op, str) and data__op == 'tanh'):
                    raise JsonSchemaValueException((*path, 'op'), 'enum', ['neg', 'abs', 'sqrt', 'exp', 'tanh'])
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
                        raise JsonSchemaValueException((*path, 'args'), 'maxItems', 1)
    try:
        data_is_dict = isinstance(data, dict)
        if data_is_dict:
            data__missing_keys = set(['op']) - data.keys()
            if data__missing_keys:
                raise JsonSchemaValueException(path, 'required', ['op'], sorted(data__missing_keys))
            data_keys = set(data.keys())
            if "op" in data_keys:
                data_keys.remove("op")
                data__op = data["op"]
                if not (isinstance(data__op, str) and data__op == 'min' or isinstance(data__op, str) and data__op == 'max'):
                    raise JsonSchemaValueException((*path, 'op'), 'enum', ['min', 'max'])
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
                        raise JsonSchemaValueException((*path, 'args'), 'minItems', 2)
    try:
        data_is_dict = isinstance(data, dict)
        if data_is_dict:
            data__missing_keys = set(['op']) - data.keys()
            if data__missing_keys:
                raise JsonSchemaValueException(path, 'required', ['op'], sorted(data__missing_keys))
            data_keys = set(data.keys())
            if "op" in data_keys:
                data_keys.remove("op")
                data__op = data["op"]
                if not (isinstance(data__op, str) and data__op == 'clamp'):
                    raise JsonSchemaValueException((*path, 'op'), 'enum', ['clamp'])
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
                        raise JsonSchemaValueException((*path, 'args'), 'minItems', 3)
                    if data__args_len > 3:
                        raise JsonSchemaValueException((*path, 'args'), 'maxItems', 3)
    data_is_dict = isinstance(data, dict)
    if data_is_dict:
        data_len = len(data)
        if data_len < 1:
            raise JsonSchemaValueException(path, 'minProperties', 1)
        if "op" in data:
            data_is_dict = isinstance(data, dict)
            if data_is_dict:
                data_len = len(data)
                if data_len > 2:
                    raise JsonSchemaValueException(path, 'maxProperties', 2)
                data__missing_keys = set(['args']) - data.keys()
                if data__missing_keys:
                    raise JsonSchemaValueException(path, 'required', ['args'], sorted(data__missing_keys))
        if "args" in data:
            if "op" not in data:
                raise JsonSchemaValueException(path, 'dependencies', {'args': 'op'})
        if "signal" in data:
            data_is_dict = isinstance(data, dict)
            if data_is_dict:
                data_len = len(data)
                if data_len > 1:
                    raise JsonSchemaValueException(path, 'maxProperties', 1)
        if "param" in data:
            data_is_dict = isinstance(data, dict)
            if data_is_dict:
                data_len = len(data)
                if data_len > 1:
                    raise JsonSchemaValueException(path, 'maxProperties', 1)
        if "atom" in data:
            data_is_dict = isinstance(data, dict)
            if data_is_dict:
                data_len = len(data)
                if data_len > 1:
                    raise JsonSchemaValueException(path, 'maxProperties', 1)
        if "before" in data:
            data_is_dict = isinstance(data, dict)
            if data_is_dict:
                data_len = len(data)
                if data_len > 1:
                    raise JsonSchemaValueException(path, 'maxProperties', 1)
        if "step_length" in data:
            data_is_dict = isinstance(data, dict)
            if data_is_dict:
                data_len = len(data)
                if data_len > 1:
                    raise JsonSchemaValueException(path, 'maxProperties', 1)
        if "const" in data:
            data_is_dict = isinstance(data, dict)
            if data_is_dict:
                data_len = len(data)
                if data_len > 1:
                    raise JsonSchemaValueException(path, 'maxProperties', 1)
        if "when" in data:
            data_is_dict = isinstance(data, dict)
            if data_is_dict:
                data_len = len(data)
                if data_len > 2:
                    raise JsonSchemaValueException(path, 'maxProperties', 2)
                data__missing_keys = set(['otherwise']) - data.keys()
                if data__missing_keys:
                    raise JsonSchemaValueException(path, 'required', ['otherwise'], sorted(data__missing_keys))
        if "otherwise" in data:
            if "when" not in data:
                raise JsonSchemaValueException(path, 'dependencies', {'otherwise': 'when'})
        data_keys = set(data.keys())
        if "op" in data_keys:
            data_keys.remove("op")
            data__op = data["op"]
            if not (isinstance(data__op, str) and data__op == '+' or isinstance(data__op, str) and data__op == '-' or isinstance(data__op, str) and data__op == '*' or isinstance(data__op, str) and data__op == '/' or isinstance(data__op, str) and data__op == '^' or isinstance(data__op, str) and data__op == 'neg' or isinstance(data__op, str) and data__op == 'min' or isinstance(data__op, str) and data__op == 'max' or isinstance(data__op, str) and data__op == 'abs' or isinstance(data__op, str) and data__op == 'clamp' or isinstance(data__op, str) and data__op == 'sqrt' or isinstance(data__op, str) and data__op == 'exp' or isinstance(data__op, str) and data__op == 'tanh'):
                raise JsonSchemaValueException((*path, 'op'), 'enum', ['+', '-', '*', '/', '^', 'neg', 'min', 'max', 'abs', 'clamp', 'sqrt', 'exp', 'tanh'])
        if "args" in data_keys:
            data_keys.remove("args")
            data__args = data["args"]
            if not isinstance(data__args, (list, tuple)):
                raise JsonSchemaValueException((*path, 'args'), 'type', 'array')
            data__args_is_list = isinstance(data__args, (list, tuple))
            if data__args_is_list:
                data__args_len = len(data__args)
                if data__args_len < 1:
                    raise JsonSchemaValueException((*path, 'args'), 'minItems', 1)
                for data__args_x, data__args_item in enumerate(data__args):
                    validate___definitions_expression(data__args_item, custom_formats, (*path, 'args', data__args_x))
        if "signal" in data_keys:
            data_keys.remove("signal")
            data__signal = data["signal"]
            if not isinstance(data__signal, (str)):
                raise JsonSchemaValueException((*path, 'signal'), 'type', 'string')
            if isinstance(data__signal, str):
                data__signal_len = len(data__signal)
                if data__signal_len < 1:
                    raise JsonSchemaValueException((*path, 'signal'), 'minLength', 1)
        if "param" in data_keys:
            data_keys.remove("param")
            data__param = data["param"]
            if not isinstance(data__param, (str)):
                raise JsonSchemaValueException((*path, 'param'), 'type', 'string')
            if isinstance(data__param, str):
                data__param_len = len(data__param)
                if data__param_len < 1:
                    raise JsonSchemaValueException((*path, 'param'), 'minLength', 1)
        if "atom" in data_keys:
            data_keys.remove("atom")
            data__atom = data["atom"]
            if not isinstance(data__atom, (str)):
                raise JsonSchemaValueException((*path, 'atom'), 'type', 'string')
            if isinstance(data__atom, str):
                data__atom_len = len(data__atom)
                if data__atom_len < 1:
                    raise JsonSchemaValueException((*path, 'atom'), 'minLength', 1)
        if "before" in data_keys:
            data_keys.remove("before")
            data__before = data["before"]
            if not isinstance(data__before, (str)):
                raise JsonSchemaValueException((*path, 'before'), 'type', 'string')
            if isinstance(data__before, str):
                data__before_len = len(data__before)
                if data__before_len < 1:
                    raise JsonSchemaValueException((*path, 'before'), 'minLength', 1)
        if "step_length" in data_keys:
            data_keys.remove("step_length")
            data__steplength = data["step_length"]
            if not (isinstance(data__steplength, str) and data__steplength == 's'):
                raise JsonSchemaValueException((*path, 'step_length'), 'enum', ['s'])
        if "const" in data_keys:
            data_keys.remove("const")
            data__const = data["const"]
            if not isinstance(data__const, (int, float)) or isinstance(data__const, bool):
                raise JsonSchemaValueException((*path, 'const'), 'type', 'number')
            if isinstance(data__const, (int, float)) and not isinstance(data__const, bool):
                if data__const < -1.7976931348623157e+308:
                    raise JsonSchemaValueException((*path, 'const'), 'minimum', -1.7976931348623157e+308)
                if data__const > 1.7976931348623157e+308:
                    raise JsonSchemaValueException((*path, 'const'), 'maximum', 1.7976931348623157e+308)
        if "when" in data_keys:
            data_keys.remove("when")
            data__when = data["when"]
            if not isinstance(data__when, (list, tuple)):
                raise JsonSchemaValueException((*path, 'when'), 'type', 'array')
            data__when_is_list = isinstance(data__when, (list, tuple))
            if data__when_is_list:
                data__when_len = len(data__when)
                if data__when_len < 1:
                    raise JsonSchemaValueException((*path, 'when'), 'minItems', 1)
                for data__when_x, data__when_item in enumerate(data__when):
                    if not isinstance(data__when_item, (list, tuple)):
                        raise JsonSchemaValueException((*path, 'when', data__when_x), 'type', 'array')
                    data__when_item_is_list = isinstance(data__when_item, (list, tuple))
                    if data__when_item_is_list:
                        data__when_item_len = len(data__when_item)
                        if data__when_item_len < 2:
                            raise JsonSchemaValueException((*path, 'when', data__when_x), 'minItems', 2)
                        if data__when_item_len > 2:
                            raise JsonSchemaValueException((*path, 'when', data__when_x), 'maxItems', 2)
                        if data__when_item_len > 0:
                            data__when_item__0 = data__when_item[0]
                            validate___definitions_condition(data__when_item__0, custom_formats, (*path, 'when', data__when_x, 0))
                        if data__when_item_len > 1:
                            data__when_item__1 = data__when_item[1]
                            validate___definitions_expression(data__when_item__1, custom_formats, (*path, 'when', data__when_x, 1))
        if "otherwise" in data_keys:
            data_keys.remove("otherwise")
            data__otherwise = data["otherwise"]
            validate___definitions_expression(data__otherwise, custom_formats, (*path, 'otherwise'))
        if data_keys:
            raise JsonSchemaValueException(path, 'additionalProperties', False, sorted(data_keys))
    return data

def validate___definitions_condition(data: object, custom_formats: object = {}, path: JsonPath = ()) -> object:
    if not isinstance(data, (dict)):
        raise JsonSchemaValueException(path, 'type', 'object')
    data_is_dict = isinstance(data, dict)
    if data_is_dict:
        data__missing_keys = set(['op', 'args']) - data.keys()
        if data__missing_keys:
            raise JsonSchemaValueException(path, 'required', ['op', 'args'], sorted(data__missing_keys))
        data_keys = set(data.keys())
        if "op" in data_keys:
            data_keys.remove("op")
            data__op = data["op"]
            if not (isinstance(data__op, str) and data__op == '<' or isinstance(data__op, str) and data__op == '<=' or isinstance(data__op, str) and data__op == '>' or isinstance(data__op, str) and data__op == '>=' or isinstance(data__op, str) and data__op == 'and' or isinstance(data__op, str) and data__op == 'or' or isinstance(data__op, str) and data__op == 'not'):
                raise JsonSchemaValueException((*path, 'op'), 'enum', ['<', '<=', '>', '>=', 'and', 'or', 'not'])
        if "args" in data_keys:
            data_keys.remove("args")
            data__args = data["args"]
            if not isinstance(data__args, (list, tuple)):
                raise JsonSchemaValueException((*path, 'args'), 'type', 'array')
            data__args_is_list = isinstance(data__args, (list, tuple))
            if data__args_is_list:
                data__args_len = len(data__args)
                if data__args_len < 1:
                    raise JsonSchemaValueException((*path, 'args'), 'minItems', 1)
        if data_keys:
            raise JsonSchemaValueException(path, 'additionalProperties', False, sorted(data_keys))
    try:
        data_is_dict = isinstance(data, dict)
        if data_is_dict:
            data_keys = set(data.keys())
            if "op" in data_keys:
                data_keys.remove("op")
                data__op = data["op"]
                if not (isinstance(data__op, str) and data__op == 'and' or isinstance(data__op, str) and data__op == 'or' or isinstance(data__op, str) and data__op == 'not'):
                    raise JsonSchemaValueException((*path, 'op'), 'enum', ['and', 'or', 'not'])
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
                        raise JsonSchemaValueException((*path, 'args'), 'minItems', 2)
                    if data__args_len > 2:
                        raise JsonSchemaValueException((*path, 'args'), 'maxItems', 2)
                    for data__args_x, data__args_item in enumerate(data__args):
                        validate___definitions_expression(data__args_item, custom_formats, (*path, 'args', data__args_x))
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
                        validate___definitions_condition(data__args_item, custom_formats, (*path, 'args', data__args_x))
    return data
