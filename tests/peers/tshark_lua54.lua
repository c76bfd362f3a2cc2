-- What a dissector needs of Wireshark, in plain Lua 5.4: Debian's tshark has Lua 5.2, Wireshark from 4.4 has 5.4.
--
--   lua5.4 tshark_lua54.lua DISSECTOR MODEL < FRAMES
--
-- A frame is a line `NUMBER TIME CHANNEL ID BITS DATA`, with `-` for no data.
-- Its fields are written on a line, `NAME=VALUE` with tabs between.

local shown, current

local function any_name(value)
  return setmetatable({}, { __index = function() return value end })
end

-- Numbers of 64 bits, kept as the integers that Lua 5.4 has.

local function unsigned_text(value)
  if value >= 0 then return string.format("%d", value) end
  local tens = (value >> 1) // 5
  return string.format("%d%d", tens, value - tens * 10)
end

local Word = {}
Word.__index = Word

local function word(value, is_signed)
  return setmetatable({ value = value, is_signed = is_signed }, Word)
end

function Word:rshift(count) return word(self.value >> math.tointeger(count)) end
function Word:lshift(count) return word(self.value << math.tointeger(count)) end
function Word:band(other) return word(self.value & (type(other) == "number" and math.tointeger(other) or other.value)) end
function Word:bxor(other) return word(self.value ~ other.value) end
function Word:bor(other) return word(self.value | other.value) end
function Word:lower() return self.value & 0xFFFFFFFF end
function Word:higher() return self.value >> 32 end
function Word:tonumber() return tonumber(tostring(self)) + 0.0 end
function Word:tohex(count)
  local digits = math.abs(math.tointeger(count))
  return string.format(count < 0 and "%016X" or "%016x", self.value):sub(-digits)
end
function Word.__lt(one, other)
  if one.is_signed then return one.value < other.value end
  return math.ult(one.value, other.value)
end
function Word.__le(one, other) return not (other < one) end
function Word.__add(one, other) return word(one.value + other.value) end
function Word.__sub(one, other) return word(one.value - other.value) end
function Word.__mul(one, other) return word(one.value * other.value) end
function Word.__tostring(self)
  return self.is_signed and string.format("%d", self.value) or unsigned_text(self.value)
end

local function constructor(is_signed)
  return function(_, low, high)
    return word(math.tointeger(low) | math.tointeger(high or 0) << 32, is_signed)
  end
end

UInt64 = setmetatable({ max = function() return word(-1) end }, { __call = constructor(false) })
Int64 = setmetatable({}, { __call = constructor(true) })

-- Fields and the tree: what is added is remembered as text.

ProtoField = setmetatable({}, {
  __index = function(_, kind)
    return function(name) return { name = name, kind = kind } end
  end,
})
ProtoExpert = { new = function(name) return { name = name } end }
base, frametype = any_name(0), any_name(0)
expert = { group = any_name(0), severity = any_name(0) }

local function text(kind, value)
  if kind == "double" then return string.format("%.15g", value) end
  if kind == "bool" then return value and "1" or "0" end
  if kind == "string" then
    assert(type(value) == "string")
    return value
  end
  if kind == "relative_time" then return string.format("%.9f", value:tonumber()) end
  return getmetatable(value) == Word and tostring(value) or string.format("%d", value)
end

local Item = {}
Item.__index = Item

function Item:add(field, range, value)
  if value == nil then range, value = nil, range end
  if field.kind then shown[#shown + 1] = field.name .. "=" .. text(field.kind, value) end
  return self
end
function Item:add_proto_expert_info(field, about)
  assert(type(about) == "string")
  shown[#shown + 1] = field.name .. "=1"
  shown[#shown + 1] = "_ws.expert.message=" .. about
end
function Item:append_text() return self end
function Item:prepend_text() return self end
function Item:set_generated() return self end

-- Packets.

local function bytes_of(hex)
  local bytes = {}
  for pair in hex:gmatch("%x%x") do
    bytes[#bytes + 1] = tonumber(pair, 16)
  end
  return bytes
end

local Range = {}
Range.__index = Range

function Range:number(from, to, step)
  local value = 0
  for index = from, to, step do
    value = value << 8 | self.bytes[index]
  end
  return word(value)
end
function Range:uint64() return self:number(self.first + 1, self.first + self.count, 1) end
function Range:le_uint64() return self:number(self.first + self.count, self.first + 1, -1) end

local Buffer = {}
Buffer.__index = Buffer
function Buffer:len() return #self.bytes end
function Buffer:reported_len() return #self.bytes end
function Buffer:__call(first, count)
  first, count = first or 0, count or #self.bytes
  assert(first + count <= #self.bytes, "the range is out of bounds")
  return setmetatable({ bytes = self.bytes, first = first, count = count }, Range)
end

local function buffer(bytes)
  return setmetatable({ bytes = bytes }, Buffer)
end
ByteArray = {
  new = function(hex)
    return { tvb = function() return buffer(bytes_of(hex)) end }
  end,
}

Field = {
  new = function(name)
    return function()
      if current[name] ~= nil then return { value = current[name] } end
    end
  end,
}

-- Moments, and the time between two, in whole nanoseconds.

local Moment = {}
Moment.__index = Moment

local function moment(nanoseconds) return setmetatable({ nanoseconds = nanoseconds }, Moment) end

function Moment:tonumber() return self.nanoseconds / 1e9 end
Moment.__sub = function(later, earlier) return moment(later.nanoseconds - earlier.nanoseconds) end

local model = math.tointeger(arg[2])
Pref = { enum = function() return model end }
DissectorTable = { get = function() return { add_for_decode_as = function() end } end }

local proto
function Proto(name)
  proto = { name = name, prefs = {}, register_heuristic = function() end }
  return proto
end

dofile(arg[1])
proto.init()
for line in io.lines() do
  local number, time, channel, id, width, data = line:match("(%d+) (%S+) (%S+) (%x+) (%d+) (%S+)")
  shown = {}
  current = {
    ["can.id"] = tonumber(id, 16),
    ["can.flags.xtd"] = width == "29",
    ["can.flags.rtr"] = false,
    ["frame.interface_id"] = channel,
    ["frame.time_epoch"] = moment(math.floor(time * 1e9 + 0.5)),
  }
  local pinfo = { cols = {}, number = math.tointeger(number) }
  proto.dissector(buffer(bytes_of(data)), pinfo, setmetatable({}, Item))
  print(table.concat(shown, "\t") .. "\t_ws.col.Info=" .. (pinfo.cols.info or ""))
end
