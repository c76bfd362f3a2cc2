-- Numbered parts: joins those of each device, and those to it. They come in their order.

local open_parts, counts

local function forget_parts()
  open_parts, counts = {}, {}
end

-- Returns the addresses of a frame. `is_module` leaves those out that every controller has.
local function peers(frame, decoded, is_module)
  local found = {}
  for _, address in ipairs(decoded.addressing.pattern.addresses) do
    if not (is_module and protocol.address_types[address.type].sent) then
      table.insert(found, string.format("%d=%d", address.type, identifier_field(frame, address.field)))
    end
  end
  table.sort(found)
  return frame.interface .. " " .. table.concat(found, " ")
end

-- Returns the raw value of one of a frame's signals, or nil if the frame does not have it.
local function raw_value(frame, decoded, signal)
  for _, known in ipairs(decoded.readings) do
    if known.signal == signal then return get(frame, signal.place) end
  end
end

-- The messages in parts whose elements another message counts.
local counted = {}
for _, message in ipairs(protocol.messages) do
  local count = message.long and message.long.parts and message.long.parts.count
  if count then
    local counting = protocol.messages[count.message]
    table.insert(counted, { name = message.name, by = counting, signal = counting.signals[count.signal] })
  end
end

-- Remembers how many elements a device says that its arrays have.
local function keep_counts(frame, decoded)
  for _, known in ipairs(counted) do
    local raw = known.by == decoded.layout.message and raw_value(frame, decoded, known.signal)
    if raw then counts[peers(frame, decoded, true) .. " " .. known.name] = double(raw) end
  end
end

-- Tests whether a frame says that no other follows.
local function is_last(frame)
  local known = protocol.continuation
  if not known then return false end
  local place = known.selector and protocol.selectors[known.selector].place
  local value = place and key(get(frame, place)) or known.field and identifier_field(frame, known.field)
  return value ~= known.value
end

-- Returns how many bytes before the data say how many there are.
local function head_of(parts)
  return parts.length and parts.length.width / 8 or 0
end

local function parts_of(long, bytes)
  return math.max(1, math.ceil((head_of(long.parts) + bytes) / long.parts.size))
end

-- Returns the number of parts, or nil if it is not known.
local function expected_parts(open, count)
  local long = open.long
  if open.announced then return math.min(parts_of(long, open.announced), parts_of(long, longest(long))) end
  if long.elements and not count then return nil end
  return parts_of(long, bytes_with(long, count))
end

-- Says that a message ended before its last field, or returns nil.
local function too_short(long, came)
  if came >= least(long) then return nil end
  return string.format("%s came, but the message has %s", in_bytes(came), other_lengths(long, came))
end

-- Cuts joined data off where the first part says that they end. It returns what is wrong with that, too.
local function cut(open, whole, lacking)
  local head = 2 * head_of(open.long.parts)
  whole.data = whole.data:sub(head + 1)
  if not open.announced then return lacking or too_short(open.long, math.floor(#whole.data / 2)) end
  whole.data = whole.data:sub(1, 2 * open.announced)
  whole.count, whole.is_counted, whole.is_ended = elements_in(open.long, open.announced), true, true
  local known = other_lengths(open.long, open.announced)
  if not known then return lacking end
  local wrong = string.format("%s announced, but the message has %s", in_bytes(open.announced), known)
  return lacking and lacking .. "; " .. wrong or wrong
end

-- Ends a message. `expected` is the number of its parts, if the frames say it.
local function end_parts(open, expected, ended)
  local is_counted = counts[open.counted] or open.is_ended or not open.long.elements
  open_parts[open.key] = nil
  local long, size, data, numbers = open.long, open.long.parts.size, {}, {}
  expected = expected or expected_parts(open, counts[open.counted])
  for index = 0, open.last do
    data[index + 1] = open.parts[index] or string.rep(".", 2 * size)
  end
  for index = 0, (expected or open.last + 1) - 1 do
    if not open.parts[index] then table.insert(numbers, string.format("%d", open.first + index)) end
  end
  local whole = { long = long, data = table.concat(data), count = counts[open.counted] }
  whole.is_counted, whole.is_ended = is_counted, open.is_ended
  whole.incomplete = cut(open, whole, missing(numbers, "part", "parts"))
  table.insert(ended, whole)
end

-- Ends the messages that silence has ended on the interface of a frame, the oldest first.
local function end_silent(frame, ended)
  local silent = {}
  for _, open in pairs(open_parts) do
    local silence = open.interface == frame.interface and open.long.parts.silence
    if silence and (frame.time - open.since):tonumber() >= silence then table.insert(silent, open) end
  end
  table.sort(silent, function(one, other) return one.number < other.number end)
  for _, open in ipairs(silent) do
    open.is_ended = true
    end_parts(open, nil, ended)
  end
end

-- Returns the part that a frame carries, if its number is one of the message's.
local function part_of(frame, decoded, first)
  local long, signals = decoded.layout.message.long, decoded.layout.message.signals
  local number = raw_value(frame, decoded, signals[long.parts.number])
  if not (number and first) then return nil end
  local index = double(number) - first
  if index < 0 or index >= parts_of(long, longest(long)) then return nil end
  local counter = long.parts.counter and double(raw_value(frame, decoded, signals[long.parts.counter]))
  local announced = index == 0 and long.parts.length and double(get(frame, long.parts.length)) or nil
  return { index = index, data = digits(get(frame, long.parts.data), 2 * long.parts.size), counter = counter, announced = announced }
end

-- Takes a frame of a message in parts, and adds the messages that it ends.
local function take_part(frame, decoded, ended)
  end_silent(frame, ended)
  if not decoded.addressing.mode then return end
  local is_error = refusal(decoded)
  if not is_error then keep_counts(frame, decoded) end
  local message = decoded.layout.message
  local long = message.long
  if not (long and long.parts) then return end
  local first = first_part(long.parts, frame.model)
  local between = peers(frame, decoded) .. " " .. message.name
  local part = not is_error and part_of(frame, decoded, first)
  if not part then
    local answer = open_parts[between .. " false"]
    if answer and decoded.layout.kind == "request" then end_parts(answer, nil, ended) end
    return
  end
  local this = between .. " " .. tostring(is_to_module(decoded.layout))
  local open = open_parts[this]
  local is_its = open and open.counter == part.counter
  if is_its and open.last == part.index and open.parts[open.last] == part.data then
    open.since = frame.time
    return
  end
  if not is_its or open.last >= part.index then
    if open then end_parts(open, nil, ended) end
    open = { key = this, long = long, first = first, parts = {} }
    open.counter, open.announced = part.counter, part.announced
    open.interface, open.number = frame.interface, frame.number
    open_parts[this] = open
  end
  -- What a device is told may change how many elements it has.
  open.counted = not decoded.layout.told and peers(frame, decoded, true) .. " " .. message.name
  open.last, open.parts[part.index], open.since = part.index, part.data, frame.time
  open.is_ended = not long.parts.length and is_last(frame)
  local expected = open.is_ended and part.index + 1 or expected_parts(open, counts[open.counted])
  if (expected or parts_of(long, longest(long))) <= part.index + 1 then
    end_parts(open, expected, ended)
  end
end
