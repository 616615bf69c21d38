"""Variables and structures as values, where numba's compiler puts them into memory and takes them out again.

numba writes 20 instructions for a field that is an array, and as many for an item of it: each time a place on the
stack, filled with zeros and then member by member. A variable that is read in another block has such a place, too. LLVM
finds out that none of this is needed, and makes the same machine code; but half of what it was given to read was of
this kind, and a tenth of all the time went into it.
"""

import functools
from collections import Counter

from llvmlite import ir
from llvmlite.ir.instructions import InsertValue
from numba.core import cgutils, lowering, types
from numba.core import ir as numba_ir
from numba.core.analysis import compute_use_defs
from numba.np import arrayobj

_create_struct_proxy, _make_array = cgutils.create_struct_proxy, arrayobj.make_array
_find_values, _store_variable = lowering.Lower._find_singly_assigned_variable, lowering.Lower.storevar
_extract_value, _insert_value, _mul = ir.IRBuilder.extract_value, ir.IRBuilder.insert_value, ir.IRBuilder.mul


class _KnownMembers(cgutils.ValueStructProxy):
    """A structure whose members are known in the block where it was made; for other blocks it goes into memory."""

    def __init__(self, context, builder, value=None, ref=None):
        self._home = None
        if ref is not None:
            super().__init__(context, builder, value, ref)
            return
        self._context, self._builder = context, builder
        self._datamodel = context.data_model_manager[self._fe_type]
        self._be_type = self._get_be_type(self._datamodel)
        self._home, self._members = builder.basic_block, {}
        self._setvalue(self._be_type(None) if value is None else value)

    def __getattr__(self, name):
        """numba's own methods ask for the place in memory."""
        if name in ("_value", "_outer_ref"):
            self._store()
            return self._value
        return super().__getattr__(name)

    def _store(self):
        """Put the structure into memory, at the end of the block where it was made."""
        self._value = self._outer_ref = cgutils.alloca_once(self._builder, self._be_type)
        with self._builder.goto_block(self._home):
            self._builder.store(self._getvalue(), self._value)
        self._home = None

    def _here(self):
        """Whether the members are known, and the builder is in their block."""
        return self._home is not None and self._home is self._builder.basic_block

    def __getitem__(self, index):
        if not self._here():
            return super().__getitem__(index)
        if index not in self._members:
            self._members[index] = self._builder.extract_value(self._whole, index)
        return self._members[index]

    def __setitem__(self, index, value):
        if not self._here() or value.type != self._be_type.elements[index]:
            super().__setitem__(index, value)
        else:
            self._members[index] = value
            self._changed.add(index)

    def _getvalue(self):
        if not self._here():
            return super()._getvalue()
        # constants first: put into a constant, they need no instruction
        for index in sorted(self._changed, key=lambda i: not isinstance(self._members[i], ir.Constant)):
            self._whole = self._builder.insert_value(self._whole, self._members[index], index)
        self._changed.clear()
        return self._whole

    def _setvalue(self, value):
        if value.type != self._be_type:
            raise TypeError(f"{value.type} where {self._be_type} is expected")
        if not self._here():
            super()._setvalue(value)
        else:
            self._whole, self._members, self._changed = value, {}, set()


@functools.cache
def _with_known_members(fe_type):
    return type(f"Held_{type(fe_type).__name__}", (_KnownMembers,), {"_fe_type": fe_type})


def create_struct_proxy(fe_type, kind="value"):
    """`cgutils.create_struct_proxy`, where kind is "value" or "data": values of the type, or what is stored of it."""
    return _with_known_members(fe_type) if kind == "value" else _create_struct_proxy(fe_type, kind)


def make_array(array_type):
    """`arrayobj.make_array`; numba's own arrays need no search for what makes an array of a user's type."""
    return _with_known_members(array_type) if isinstance(array_type, types.Array) else _make_array(array_type)


def extract_value(self, whole, place, name=""):
    """`IRBuilder.extract_value`, where what was inserted there, or is constant, needs no instruction."""
    place = [place] if isinstance(place, int) else list(place)
    if len(place) == 1:
        while isinstance(whole, InsertValue) and whole.indices[0] != place[0]:
            whole = whole.aggregate
        if isinstance(whole, InsertValue) and len(whole.indices) == 1:
            return whole.value
        if isinstance(whole, ir.Constant):
            return _members(whole)[place[0]]
    return _extract_value(self, whole, place, name)


def insert_value(self, whole, value, place, name=""):
    """`IRBuilder.insert_value`, where a constant within a constant is a constant."""
    index = place if isinstance(place, int) else place[0] if len(place) == 1 else None
    if index is None or not (isinstance(whole, ir.Constant) and isinstance(value, ir.Constant)):
        return _insert_value(self, whole, value, place, name)
    members = _members(whole)
    members[index] = value
    return ir.Constant(whole.type, members)


def mul(self, x, y, name="", flags=()):
    """`IRBuilder.mul`, where the product of two constants is a constant."""
    if all(isinstance(factor, ir.Constant) and isinstance(factor.constant, int) for factor in (x, y)):
        return x.type(x.constant * y.constant)
    return _mul(self, x, y, name, flags)


def _members(whole):
    """The members of a constant."""
    if isinstance(whole.constant, list):
        return list(whole.constant)
    return [kind(whole.constant) for kind in whole.type.elements]  # all of them zero, or undefined


def find_values(self):
    """`Lower._find_singly_assigned_variable` for all blocks: what is assigned once, and before it is read."""
    if self.context.enable_nrt or self.func_ir.is_generator:
        _find_values(self)
        return
    uses, seen, early, assigned = compute_use_defs(self.blocks), set(), set(), Counter()
    for label, block in self.blocks.items():
        early |= uses.usemap[label] - seen
        seen |= uses.defmap[label]
        assigned.update(step.target.name for step in block.find_insts(numba_ir.Assign))
    self._singly_assigned_vars = {name for name, times in assigned.items() if times == 1} - early
    self._blk_local_varmap = {}


def store_variable(self, value, name, argidx=None):
    """`Lower.storevar` without a look at what was there before, where no references to it are counted."""
    if name in self._singly_assigned_vars or self.context.enable_nrt:
        _store_variable(self, value, name, argidx)
    else:
        self.builder.store(value, self.getvar(name))
