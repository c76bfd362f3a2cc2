-- Transfers by ISO-TP: joins a single frame, or a first frame and consecutive ones, of each sender.

local SINGLE, LONGEST, OVERFLOW = 7, 4095, 2

-- The messages that have begun, and the place of each by its key.
local open_messages, places

local function forget_messages()
  open_messages, places = {}, {}
end

-- Returns who sends a frame, and to whom. Named addresses are not sent by everybody.
local function ends_of(frame, decoded, transport)
  local ends = { to_module = is_to_module(decoded.layout), mode = decoded.addressing.mode, addresses = {}, named = {} }
  ends.bus = frame.interface .. " " .. transport.name
  ends.key = string.format("%s %d %s", ends.bus, frame.id, tostring(ends.to_module))
  local pattern = decoded.addressing.pattern
  for _, address in ipairs(pattern and pattern.addresses or {}) do
    local value = identifier_field(frame, address.field)
    ends.addresses[address.type] = value
    if not protocol.address_types[address.type].sent then ends.named[address.type] = value end
  end
  return ends
end

-- Tests whether all addresses of one frame are those of the other.
local function agree(ones, others, may_lack)
  for kind, value in pairs(ones) do
    local other = others[kind]
    if other ~= value and not (may_lack and other == nil) then return false end
  end
  return true
end

-- Tests whether a frame of the receiver answers one of the sender. Its mode can be another one, if addresses show who
-- they are.
local function answers_sender(own, sender)
  if own.bus ~= sender.bus or own.to_module == sender.to_module then return false end
  local is_between = agree(own.named, sender.named) and agree(sender.named, own.named)
  return is_between and agree(own.addresses, sender.addresses, true) and (own.mode == sender.mode or next(own.named))
end

-- Returns joined data as if their first bytes were a frame.
local function beginning(frame, data)
  local digits = (data:gsub("%.", "0") .. string.rep("0", 16)):sub(1, 16)
  local length = math.min(8, math.floor(#data / 2))
  return { id = frame.id, big = word(digits), little = word((digits:reverse():gsub("(.)(.)", "%2%1"))), length = length }
end

-- Finds the message whose data begin so: one of the device model, or else the first.
local function message_of(frame, decoded, transport, data, size)
  local first
  for _, message in ipairs(protocol.messages) do
    local via = message.long and message.long.via
    if via and via.name == transport.name then
      local shown = with_data(beginning(frame, data), with_identifier(frame, via.layouts))
      shown = filtered(shown, function(layout)
        return layout.to_module == is_to_module(decoded.layout) and layout.head <= size
      end)
      first = first or shown[1]
      if shown[1] and is_of_model(message, frame.model) then return shown[1] end
    end
  end
  return first
end

-- Returns the digits of the data of a frame behind its first bytes.
local function data_behind(frame, bytes)
  return frame.big:tohex(-16):sub(2 * bytes + 1, 2 * frame.length)
end

-- Says what is missing of a message, or returns nil. `why` says what ended it before its time.
local function lacking(open, why)
  local came = math.floor(#open.data / 2)
  if came == open.size then
    local known = other_lengths(open.layout.long, open.size, open.layout)
    return known and string.format("%s came, but the message has %s", in_bytes(open.size), known)
  end
  return string.format("%d of %d bytes came", came, open.size) .. (why and "; " .. why or "")
end

-- Adds a message, or what came of it.
local function add_message(open, why, ended)
  local layout = open.layout
  local whole = { long = layout.long, layout = layout, is_counted = true, is_ended = true }
  whole.incomplete = lacking(open, why)
  whole.data = open.data .. string.rep(".", 2 * open.size - #open.data)
  whole.count = elements_in(layout.long, open.size, layout)
  whole.beginning = beginning(open.frame, whole.data)
  table.insert(ended, whole)
end

-- Begins a message.
local function begin_message(open)
  table.insert(open_messages, open)
  places[open.ends.key] = #open_messages
end

-- Ends the message at a place. The last one takes the place.
local function end_message(place, why, ended)
  local open, last = open_messages[place], open_messages[#open_messages]
  open_messages[place], places[last.ends.key] = last, place
  open_messages[#open_messages], places[open.ends.key] = nil, nil
  add_message(open, why, ended)
end

-- Ends the message that a sender has begun before.
local function restart(ends, ended)
  local place = places[ends.key]
  if place then end_message(place, "another message begins", ended) end
end

function take.single_frame(frame, decoded, transport, ended)
  local size = number(frame, decoded, "size")
  if not size or size < 1 or size > frame.length - 1 then return end
  local ends, data = ends_of(frame, decoded, transport), data_behind(frame, 1):sub(1, 2 * size)
  restart(ends, ended)
  local layout = message_of(frame, decoded, transport, data, size)
  if layout then add_message({ frame = frame, layout = layout, size = size, data = data }, nil, ended) end
end

-- Tests whether a first frame announces a message that is too long for twelve bits of size. Then the size stands in four
-- bytes of its own.
local function is_too_long(frame, size)
  local own_size = data_behind(frame, 2):sub(1, 8)
  return size == 0 and #own_size == 8 and tonumber(own_size, 16) > LONGEST
end

function take.first_frame(frame, decoded, transport, ended)
  local size, data = number(frame, decoded, "size"), data_behind(frame, 2)
  if not size then return end
  if is_too_long(frame, size) then return restart(ends_of(frame, decoded, transport), ended) end
  if size <= SINGLE then return end
  local ends = ends_of(frame, decoded, transport)
  restart(ends, ended)
  local layout = message_of(frame, decoded, transport, data, size)
  local open = { frame = frame, ends = ends, layout = layout, size = size, data = data, count = 1 }
  if layout then begin_message(open) end
end

function take.consecutive_frame(frame, decoded, transport, ended)
  local place, index = places[ends_of(frame, decoded, transport).key], number(frame, decoded, "number")
  local open = open_messages[place]
  if not open or not index then return end
  local wanted = open.count % 16
  if index ~= wanted then
    return end_message(place, string.format("frame number %d came in place of %d", index, wanted), ended)
  end
  local missing_bytes = open.size - math.floor(#open.data / 2)
  local bytes = math.min(missing_bytes, SINGLE)
  if frame.length - 1 < bytes then return end
  open.data, open.count = open.data .. data_behind(frame, 1):sub(1, 2 * bytes), open.count + 1
  if missing_bytes <= SINGLE then end_message(place, nil, ended) end
end

function take.flow_control(frame, decoded, transport, ended)
  local own = ends_of(frame, decoded, transport)
  for place, open in ipairs(open_messages) do
    if answers_sender(own, open.ends) then
      if number(frame, decoded, "status") == OVERFLOW then
        end_message(place, "the receiver has no room for it", ended)
      end
      return
    end
  end
end
