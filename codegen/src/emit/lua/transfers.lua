-- Transfers by J1939: joins the packets of a message.

local PACKET, EVERYBODY = 7, 0xFF

local open_transfers

local function forget_transfers()
  open_transfers = {}
end

-- The frames of transports by their message: the transport, and what the frame does.
local transports = {}
for _, transport in ipairs(protocol.transports or {}) do
  for what, index in pairs(transport.frames) do
    transports[protocol.messages[index]] = { transport = transport, what = what }
  end
end

-- Returns the number that a frame of a transport has under a name.
local function number(frame, decoded, name)
  for _, known in ipairs(decoded.readings) do
    if known.signal.name == name then return double(get(frame, known.signal.place)) end
  end
end

-- Returns the number of a group without the address that can stand in its last byte.
local function without_receiver(group)
  group = bits(group, 0, 18)
  return bits(group, 8, 8) < 0xF0 and group - group % 256 or group
end

-- Returns the name of a transfer between two nodes.
local function transfer_key(frame, transport, sender, receiver)
  return table.concat({ frame.interface, transport.name, string.format("%d %d", sender, receiver) }, " ")
end

-- Returns the name of the transfer if the sender sends the frame, its name if the receiver does, and the receiver.
local function ends(frame, transport)
  local source, target = identifier_field(frame, transport.source), identifier_field(frame, transport.target)
  return transfer_key(frame, transport, source, target), transfer_key(frame, transport, target, source), target
end

-- Puts a value into a field of an identifier.
local function put(id, index, value)
  local field = protocol.identifier.fields[index]
  return id + (value - bits(id, field.shift, field.width)) * 2 ^ field.shift
end

-- Returns an identifier that shows a group. The receiver stays, if the identifier has room for it.
local function with_group(frame, transport, group)
  local id = frame.id
  if bits(group, 8, 8) < 0xF0 then group = without_receiver(group) + identifier_field(frame, transport.target) end
  for index = #transport.group, 1, -1 do
    local field = transport.group[index]
    local width = protocol.identifier.fields[field].width
    id, group = put(id, field, bits(group, 0, width)), math.floor(group / 2 ^ width)
  end
  return id
end

-- Finds the long message of a group.
local function long_of(frame, decoded, transport, group)
  local shown = { id = with_group(frame, transport, group) }
  for _, message in ipairs(protocol.messages) do
    local via = message.long and message.long.via
    for _, layout in ipairs(via and via.name == transport.name and via.layouts or {}) do
      local is_its = layout.to_module == is_to_module(decoded.layout)
      if is_its and #with_identifier(shown, { layout }) == 1 then return message.long end
    end
  end
end

-- Ends a transfer. `why` says what ended it before its time.
local function end_transfer(open, why, ended)
  open_transfers[open.key] = nil
  if open.is_done then return end
  local data, numbers = {}, {}
  for index = 1, open.count do
    data[index] = open.packets[index] or string.rep(".", 2 * PACKET)
    if not open.packets[index] then table.insert(numbers, string.format("%d", index)) end
  end
  local what = missing(numbers, "packet", "packets")
  if not what and open.count > 0 then
    local known = other_lengths(open.long, open.size)
    if known then
      what = string.format("%s came, but the message has %s", in_bytes(open.size), known)
    else
      why = nil
    end
  end
  local whole = { long = open.long, data = table.concat(data):sub(1, 2 * open.size) }
  whole.is_counted, whole.is_ended, whole.count = true, true, elements_in(open.long, open.size)
  whole.incomplete = what and why and what .. "; " .. why or what or why
  table.insert(ended, whole)
end

local take = {}

local function begin(frame, decoded, transport, ended)
  local this = ends(frame, transport)
  if open_transfers[this] then end_transfer(open_transfers[this], "another message begins", ended) end
  local size, count, group =
    number(frame, decoded, "size"), number(frame, decoded, "packets"), number(frame, decoded, "group")
  local long = size and count and group and long_of(frame, decoded, transport, group)
  if not long then return end
  local is_right = math.ceil(size / PACKET) == count
  for _, note in ipairs(decoded.notes) do
    is_right = is_right and note.rule ~= "out_of_range"
  end
  local open = { key = this, long = long, size = size, group = without_receiver(group), count = count, packets = {} }
  open_transfers[this] = open
  if is_right then return end
  open.count = 0
  end_transfer(open, string.format("%d bytes in %d packets are announced", size, count), ended)
end

take.request_to_send, take.broadcast = begin, begin

function take.data(frame, decoded, transport, ended)
  local this, _, receiver = ends(frame, transport)
  local open, index = open_transfers[this], number(frame, decoded, "number")
  if not open or open.is_done or not index or index < 1 or index > open.count then return end
  local data = frame.big:tohex(-16):sub(3)
  if not (open.again and index >= open.again) then
    if open.packets[index] == data then return end
    if open.packets[index] then
      return end_transfer(open, string.format("packet %d came twice, with other data", index), ended)
    end
    for later = index + 1, open.count do
      if open.packets[later] then
        return end_transfer(open, string.format("packet %d came after packet %d", index, later), ended)
      end
    end
  end
  open.packets[index] = data
  local is_whole = receiver == EVERYBODY and index == open.count
  if not is_whole then
    for known = 1, open.count do
      if not open.packets[known] then return end
    end
  end
  end_transfer(open, nil, ended)
  open.is_done, open_transfers[this] = true, open
end

-- The receiver lets packets come, perhaps once more.
function take.clear_to_send(frame, decoded, transport)
  local _, this = ends(frame, transport)
  local open, following = open_transfers[this], number(frame, decoded, "next")
  if not open or not following or following < 1 then return end
  open.again = nil
  for index in pairs(open.packets) do
    if index >= following then open.again = following end
  end
end

function take.end_of_message(frame, decoded, transport, ended)
  local _, this = ends(frame, transport)
  local open = open_transfers[this]
  if open then end_transfer(open, "the receiver says that it came whole", ended) end
end

function take.abort(frame, decoded, transport, ended)
  local group = number(frame, decoded, "group")
  local one, other = ends(frame, transport)
  for _, this in ipairs({ one, other }) do
    local open = open_transfers[this]
    if open and open.group == group then
      local reason = number(frame, decoded, "reason") or 0
      return end_transfer(open, string.format("the transfer is aborted for reason %d", reason), ended)
    end
  end
end

-- Takes a frame of a transport, and adds the messages that it ends.
local function take_transfer(frame, decoded, ended)
  local known = transports[decoded.layout.message]
  if known then take[known.what](frame, decoded, known.transport, ended) end
end
