-- Values: what the bits of a frame mean.
--
-- Raw values of up to 32 bits are numbers, and wider ones UInt64 or Int64. So all of them are
-- exact.

-- Returns bits of a number of up to 32 bits.
local function bits(number, shift, width)
  return math.floor(number / 2 ^ shift) % 2 ^ width
end

-- Prepares a place in the data bytes for reading.
local function prepare(place)
  place.mask = UInt64.max():rshift(64 - place.width)
end

-- Does so for all places of a signal.
local function prepare_signal(signal)
  prepare(signal.place)
  for _, own in pairs(signal.on or {}) do prepare(own.place) end
  for _, piece in ipairs(signal.pieces or {}) do
    if piece.place then prepare(piece.place) end
  end
end

-- Tests whether a frame is long enough to have a place.
local function has(frame, place)
  return place.first + place.count <= frame.length
end

-- Returns the raw value at a place, without its sign.
local function get(frame, place)
  local word = place.big and frame.big or frame.little
  local value = word:rshift(place.shift):band(place.mask)
  return place.width > 32 and value or value:lower()
end

-- Returns the same raw value as a number in two's complement.
local function signed(value, width)
  if width <= 32 then return value < 2 ^ (width - 1) and value or value - 2 ^ width end
  local is_negative = value:rshift(width - 1):lower() == 1
  if is_negative and width < 64 then value = value:bor(UInt64.max():lshift(width)) end
  return Int64(value:lower(), value:higher())
end

-- Returns a raw value in the form that the tables of names have.
local function key(value)
  return type(value) == "number" and value or tostring(value)
end

local function double(value)
  return type(value) == "number" and value or value:tonumber()
end

local function hexadecimal(value)
  return string.format("0x%02X", value)
end

-- Returns as many hexadecimal digits as a value needs, and at least `count`.
local function digits(value, count)
  if type(value) == "number" then return string.format("%0" .. count .. "X", value) end
  local all = value:tohex(-16):gsub("^0+", "")
  return string.rep("0", count - #all) .. all
end

local function plain(value)
  if type(value) ~= "number" then return tostring(value) end
  local is_whole = math.abs(value) < 2 ^ 53 and value == math.floor(value)
  return string.format(is_whole and "%.0f" or "%.15g", value)
end

local function lies_within(value, ranges)
  for _, range in ipairs(ranges) do
    if range[1] <= value and value <= range[2] then return true end
  end
  return false
end

-- Tests a value against limits. Both are Lua numbers, or neither is.
local function keeps_to(value, limits)
  return lies_within(type(limits[1]) == "number" and double(value) or value, { limits })
end

local function identifier_field(frame, index)
  local field = protocol.identifier.fields[index]
  return bits(frame.id, field.shift, field.width)
end

-- Tests the constant parts of an identifier.
local function shows(id, constants)
  for _, part in ipairs(constants) do
    if bits(id, part.shift, part.width) ~= part.value then return false end
  end
  return true
end

-- Numerals: the integer of a raw value, or nil.

local numerals = {}

-- Decimal digits of four bits each.
function numerals.bcd(raw)
  local hex = digits(raw, 1)
  if hex:find("%a") then return nil end
  if type(raw) == "number" then return tonumber(hex) end
  local high = #hex > 8 and UInt64(tonumber(hex:sub(1, -9))) or UInt64(0)
  return high * UInt64(100000000) + UInt64(tonumber(hex:sub(-8)))
end

-- Returns the integer of a signal or of a part.
local function integer(signal, raw)
  if not signal.numeral then return raw end
  return numerals[signal.numeral](raw)
end

-- Values: the physical value of a raw value, or nil and a note that says why there is none.

local values = {}

function values.integer(signal, raw)
  local number = integer(signal, raw)
  if number then return number end
  return nil, "unknown_value", signal.name .. " 0x" .. digits(raw, 1) .. " is no number"
end

function values.number(signal, raw)
  local number, rule, note = values.integer(signal, raw)
  if not number then return nil, rule, note end
  return (double(number) * signal.numerator + signal.offset) / signal.denominator
end

-- Has a value only on a device model.
function values.by_model(signal, raw)
  local names = {}
  for index, name in ipairs(protocol.models) do
    if signal.on[index] then table.insert(names, name) end
  end
  return nil, "model_dependent", signal.name .. " has a scale only on " .. table.concat(names, ", ")
end

function values.float(signal, raw)
  local exponent, fraction = bits(raw, 23, 8), bits(raw, 0, 23)
  local sign = raw < 2 ^ 31 and 1 or -1
  if exponent == 255 then
    local name = fraction ~= 0 and "NaN" or sign < 0 and "-inf" or "inf"
    return nil, "not_finite", signal.name .. " is " .. name
  end
  if exponent == 0 then return sign * fraction * 2 ^ -149 end
  return sign * (1 + fraction / 2 ^ 23) * 2 ^ (exponent - 127)
end

function values.named(signal, raw)
  local name = signal.names[key(raw)]
  if name then return name end
  return nil, "unknown_value", signal.name .. " 0x" .. digits(raw, 1) .. " has no name"
end

-- Returns the text of hexadecimal digits without the bytes that fill it up, or nil if it is not
-- ASCII without NUL.
local function ascii(hex, fill)
  while hex:sub(-2) == (fill or "00") do hex = hex:sub(1, -3) end
  local text = hex:gsub("..", function(pair) return string.char(tonumber(pair, 16)) end)
  return not text:find("[^\1-\127]") and text or nil
end

local escapes = { ["\\"] = "\\\\", ["\n"] = "\\n", ["\r"] = "\\r", ["\t"] = "\\t" }

-- Writes control characters and backslashes as escapes.
local function escaped(text)
  return (text:gsub("[%c\\]", function(letter)
    return escapes[letter] or string.format("\\x%02X", letter:byte())
  end))
end

local function not_of_form(signal)
  return nil, "unknown_value", signal.name .. " is not a text of the documented form"
end

-- Texts of hexadecimal digits: those of characters, and the digits themselves.

local texts = {}

function texts.text(signal, hex)
  local text = ascii(hex, signal.fill)
  if text then return escaped(text) end
  return not_of_form(signal)
end

function texts.bytes(_, hex)
  return hex
end

for kind, text in pairs(texts) do
  values[kind] = function(signal, raw)
    return text(signal, digits(raw, math.floor(signal.place.width / 4)))
  end
end

-- Returns the text of a part of a packed value, if that text gives the same bits again.
local function piece_text(frame, piece)
  local raw, width = get(frame, piece.place), piece.place.width
  if piece.text then
    local text = ascii(digits(raw, math.floor(width / 4)))
    return text and #text == width / 8 and text or nil
  end
  raw = integer(piece, raw)
  if not raw or piece.range and not keeps_to(raw, piece.range) then return nil end
  local number = type(raw) == "number" and string.format("%d", raw) or tostring(raw)
  if not piece.digits then return number end
  return #number <= piece.digits and string.rep("0", piece.digits - #number) .. number or nil
end

function values.packed(signal, _, frame)
  local text, is_open = "", false
  for _, piece in ipairs(signal.pieces) do
    local part = piece.literal or piece_text(frame, piece)
    -- A number without a fixed length ends before the first character that is no digit.
    if not part or (is_open and part:find("^%d")) then return not_of_form(signal) end
    if part ~= "" then is_open = not (piece.literal or piece.text or piece.digits) end
    text = text .. part
  end
  return escaped(text)
end

-- Returns the numbers of a status word's set bits, and a mask of those without a name.
function values.status(signal, raw)
  local set, unknown = {}, raw
  for _, bit in ipairs(signal.bits) do
    if double(raw) >= 2 ^ bit.bit then
      local is_set
      if type(raw) == "number" then
        is_set = bits(raw, bit.bit, 1) == 1
        unknown = is_set and unknown - 2 ^ bit.bit or unknown
      else
        is_set = raw:rshift(bit.bit):band(1):lower() == 1
        unknown = is_set and unknown - UInt64(1):lshift(bit.bit) or unknown
      end
      set[bit.bit] = is_set or nil
    end
  end
  if double(unknown) == 0 then return set end
  set.unknown = "0x" .. digits(unknown, 1)
  if #signal.bits == 0 then return set end
  return set, "unknown_bit", signal.name .. " has bits " .. set.unknown .. " set that have no name"
end

local function range_note(signal, model, value)
  local range = signal.model_ranges and signal.model_ranges[model] or signal.range
  if not range or keeps_to(value, range) then return end
  local unit = signal.unit and " " .. signal.unit or ""
  local limits = plain(range[1]) .. ".." .. plain(range[2]) .. unit
  return "out_of_range", signal.name .. " " .. plain(value) .. unit .. " is outside " .. limits
end

-- Returns a signal as the chosen device model has it.
local function on_model(signal, model)
  return signal.on and signal.on[model] or signal
end

-- Tests whether a device model does not have a signal.
local function lacks(signal, model)
  local known = signal.lacking and signal.lacking[model]
  return known and known.whole
end

-- Says that a device model does not have what bits or their raw value show, or that the message is long enough for. It
-- also returns whether the model lacks the signal, and whether the bits are blank then. A text has some number of bytes.
local function lack(signal, model, bits, raw, bytes)
  local known = signal.lacking and signal.lacking[model]
  if not known then return nil end
  local wide = type(bits) == "number" and UInt64(bits) or bits
  local is_blank = wide:bxor(known.blank):band(known.mask) == UInt64(0)
  local is_hidden = known.whole and is_blank
  local is_longer = known.longer and (not bytes or bytes > known.longer)
  if is_blank and not is_longer and not (known.values and known.values[key(raw)]) then
    return nil, known.whole, is_hidden
  end
  return protocol.models[model] .. " has no such `" .. signal.name .. "`", known.whole, is_hidden
end

-- Returns what a frame says about a signal: raw, value, name of a special value, rule and text of a
-- note.
local function reading(frame, known)
  local signal = on_model(known, frame.model)
  local bits = get(frame, signal.place)
  local raw = signal.signed and signed(bits, signal.place.width) or bits
  local lacked, is_whole, is_hidden = lack(signal, frame.model, bits, raw)
  local special = signal.specials and signal.specials[key(raw)]
  if special then
    local rule = lacked and "model_dependent"
    return { signal = signal, raw = raw, name = special, rule = rule, text = lacked, is_hidden = is_hidden }
  end
  local value, rule, text = values[signal.kind](signal, raw, frame)
  local is_number = signal.shown == "integer" or signal.shown == "double"
  if is_number and value then rule, text = range_note(signal, frame.model, value) end
  if lacked then rule, text = "model_dependent", lacked elseif is_whole then rule, text = nil, nil end
  -- Values of all device models stand in one field.
  if signal ~= known and is_number then value = double(value) end
  return { signal = signal, raw = raw, value = value, rule = rule, text = text, is_hidden = is_hidden }
end

-- Returns what digits say about a text that no place holds. A device model that lacks it has only blank bytes there.
local function text_reading(signal, hex, model)
  local value, rule, text = texts[signal.kind](signal, hex)
  local is_hidden = lacks(signal, model)
  if is_hidden then rule, text = nil, nil end
  for pair in hex:gmatch("..") do
    local lacked, _, is_blank = lack(signal, model, tonumber(pair, 16), nil, #hex / 2)
    if lacked then rule, text = "model_dependent", lacked end
    is_hidden = is_hidden and is_blank
  end
  return { signal = signal, raw = hex, value = value, rule = rule, text = text, is_hidden = is_hidden }
end
