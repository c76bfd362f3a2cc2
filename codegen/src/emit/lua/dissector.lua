-- The dissector: its fields, the tree of a frame, and how Wireshark finds it.

-- Names that no protocol can have: words of display filters, and groups of preferences. Wireshark ends at them.
local reserved = {}
for word in ([[
  all all_eq all_ne and any any_eq any_ne bitand bitwise_and contains eq false ge gt in inf le lt matches nan ne not or
  true xor
  capture console extcap gui nameres packet_list print protocols statistics stream taps
]]):gmatch("%S+") do
  reserved[word] = true
end

-- Tests whether a protocol can have a name. One letter is too short for Wireshark.
local function is_allowed(name)
  return #name > 1 and not reserved[name]
end

-- Returns the protocol for Wireshark, and its name in filters. Wireshark's own names are taken.
local function new_proto()
  local about = string.upper(protocol.name) .. ": " .. protocol.title
  if is_allowed(protocol.name) then
    local is_free, proto = pcall(Proto, protocol.name, about)
    if is_free then return proto, protocol.name end
  end
  local name = "canspec_" .. protocol.name
  return Proto(name, about), name
end

local proto, proto_name = new_proto()

local fields, experts = {}, {}

local function define(field)
  table.insert(fields, field)
  return field
end

-- Returns the filter name of a group of fields. A message of the same name keeps its own.
local function group(name)
  for _, message in ipairs(protocol.messages) do
    if message.name == name then return group(name .. "_") end
  end
  return proto_name .. "." .. name .. "."
end

local function title(item)
  return item.title or item.name
end

-- Returns a field for integers of `bits` bits. Integers that are no quantities are shown in
-- hexadecimal.
local function number_field(name, text, width, is_signed, display, names, about)
  local size = width <= 8 and 8 or width <= 16 and 16 or width <= 32 and 32 or 64
  local make = ProtoField[(is_signed and "int" or "uint") .. size]
  return define(make(name, text, is_signed and base.DEC or display, names, nil, about))
end

-- Shows a signal in the fields of another, on each device model.
local function share_fields(signal, other)
  signal.field, signal.name_field, signal.raw_field = other.field, other.name_field, other.raw_field
  for index, bit in ipairs(signal.bits or {}) do bit.field = other.bits[index].field end
  for _, own in pairs(signal.on or {}) do share_fields(own, other) end
end

local function define_signal(signal, prefix)
  local name, text, width = prefix .. signal.name, title(signal), signal.place.width
  if signal.shown == "integer" then
    signal.field = number_field(name, text, width, signal.signed, base.DEC)
  elseif signal.shown == "double" then
    signal.field = define(ProtoField.double(name, text))
  elseif signal.shown == "bits" then
    signal.field = number_field(name, text, width, false, base.HEX)
    for _, bit in ipairs(signal.bits) do
      bit.field = define(ProtoField.bool(name .. "." .. bit.name, title(bit)))
    end
  else
    signal.field = define(ProtoField.string(name, text))
  end
  if signal.specials then signal.name_field = define(ProtoField.string(name .. ".name", text)) end
  if signal.most then
    signal.raw_field = define(ProtoField.string(name .. ".raw", "raw"))
  elseif signal.specials or signal.numeral or (signal.shown ~= "integer" and signal.shown ~= "bits") then
    signal.raw_field = number_field(name .. ".raw", "raw", width, signal.signed, base.DEC_HEX)
  end
  for _, own in pairs(signal.on or {}) do share_fields(own, signal) end
end

-- Signals of a long message that also fits a frame share the fields of that frame. Numbered parts have other signals.
local function define_long_signal(signal, message, prefix)
  for _, known in ipairs(message.signals) do
    if known.name == signal.name and message.long.parts then return define_signal(signal, prefix .. "whole.") end
    if known.name == signal.name then return share_fields(signal, known) end
  end
  define_signal(signal, prefix)
end

local known = {}
for _, name in ipairs({ "message", "access", "kind", "addressing", "answers", "reserved", "problem", "whole" }) do
  known[name] = define(ProtoField.string(proto_name .. "." .. name, name))
end
known.request_in = define(ProtoField.framenum(proto_name .. ".request_in", "Request in", base.NONE, frametype.REQUEST))
known.response_in = define(ProtoField.framenum(proto_name .. ".response_in", "Response in", base.NONE, frametype.RESPONSE))
known.response_time = define(ProtoField.relative_time(proto_name .. ".response_time", "Response time"))

known.identifier = define(ProtoField.uint32(proto_name .. ".identifier", "identifier", base.HEX))

-- Names of values of up to 32 bits can stand in the field itself.
for _, field in ipairs(protocol.identifier.fields) do
  local name = group("identifier") .. field.name
  field.field = number_field(name, field.name, field.width, false, base.HEX_DEC, field.names, field.title)
end
for _, selector in ipairs(protocol.selectors) do
  if selector.place then
    local width = selector.place.width
    local names = width <= 32 and selector.names or nil
    local name = group("selector") .. selector.name
    selector.field = number_field(name, selector.name, width, false, base.HEX_DEC, names, selector.title)
  end
end
for _, message in ipairs(protocol.messages) do
  local prefix = proto_name .. "." .. message.name .. "."
  for _, signal in ipairs(message.signals) do
    define_signal(signal, prefix)
  end
  for _, signal in ipairs(message.long and message.long.signals or {}) do
    define_long_signal(signal, message, prefix)
  end
end

local RULES = {
  "error_code", "addressing", "address", "unknown_value", "unknown_bit", "out_of_range", "not_finite", "reserved_bit",
  "model_dependent", "count",
}
-- Rules of notes about the value of a signal.
local OF_VALUES = { unknown_value = true, unknown_bit = true, out_of_range = true, not_finite = true }
local notes = {}
for _, rule in ipairs(RULES) do
  notes[rule] = ProtoExpert.new(group("note") .. rule, rule, expert.group.PROTOCOL, expert.severity.WARN)
  table.insert(experts, notes[rule])
end
local unrecognised =
  ProtoExpert.new(group("note") .. "unrecognised", "not recognised", expert.group.PROTOCOL, expert.severity.ERROR)
table.insert(experts, unrecognised)
local incomplete =
  ProtoExpert.new(group("note") .. "incomplete", "not whole", expert.group.PROTOCOL, expert.severity.WARN)
table.insert(experts, incomplete)

proto.fields, proto.experts = fields, experts

local models = { { 1, "any", 0 } }
for index, name in ipairs(protocol.models) do
  table.insert(models, { index + 1, name, index })
end
proto.prefs.model = Pref.enum("Device model", 0, "Whose layouts and limits count", models, false)

local function add_identifier(tree, frame, decoded)
  local subtree = tree:add(known.identifier, frame.id)
  if decoded.has_other_identifier then return end
  for index, field in ipairs(protocol.identifier.fields) do
    subtree:add(field.field, identifier_field(frame, index))
  end
end

local function add_selectors(tree, tvb, decoded)
  for _, chosen in ipairs(decoded.selectors) do
    local place = chosen.selector.place
    tree:add(chosen.selector.field, tvb(place.first, place.count), chosen.value)
  end
end

-- Adds the bits of a status word. It returns the names of those that are set, and the others as a number.
local function add_bits(item, range, reading)
  local set = {}
  for _, bit in ipairs(reading.signal.bits) do
    local is_set = reading.value[bit.bit] or false
    item:add(bit.field, range, is_set)
    if is_set then table.insert(set, bit.name) end
  end
  if reading.value.unknown then table.insert(set, reading.value.unknown) end
  return #set > 0 and table.concat(set, " ") or "none"
end

-- Returns the bytes that a signal stands in.
local function range_of(tvb, reading)
  local signal = reading.signal
  if signal.most then return tvb(signal.window, math.floor(#reading.raw / 2)) end
  return tvb((signal.window or 0) + signal.place.first, signal.place.count)
end

-- Adds a signal, and returns its value as a text. Without a physical value, only the raw value is
-- added.
local function add_reading(tree, tvb, reading)
  local signal = reading.signal
  local range = range_of(tvb, reading)
  if reading.value == nil and not reading.name then
    tree:add(signal.raw_field, range, reading.raw):prepend_text(title(signal) .. ", ")
    return "?"
  end
  local item, text
  if reading.name then
    item, text = tree:add(signal.name_field, range, reading.name), reading.name
  elseif signal.shown == "bits" then
    item = tree:add(signal.field, range, reading.raw)
    text = add_bits(item, range, reading)
  else
    item, text = tree:add(signal.field, range, reading.value), plain(reading.value)
    if signal.unit then
      item:append_text(" " .. signal.unit)
      text = text .. " " .. signal.unit
    end
  end
  if signal.raw_field then item:add(signal.raw_field, range, reading.raw) end
  return text
end

local function add_links(tree, frame, decoded)
  local who = answering(decoded)
  if who then tree:add(known.answers, who):set_generated() end
  local request = requests[frame.number]
  if request then
    tree:add(known.request_in, request.number):set_generated()
    tree:add(known.response_time, request.time):set_generated()
  end
  for _, number in ipairs(responses[frame.number] or {}) do
    tree:add(known.response_in, number):set_generated()
  end
end

local function show_problem(frame, decoded, tvb, tree)
  tree:append_text(", not recognised")
  tree:add(known.problem, decoded.problem)
  add_identifier(tree, frame, decoded)
  add_selectors(tree, tvb, decoded)
  tree:add_proto_expert_info(unrecognised, decoded.text)
end

-- Shows a message, and returns what the list of packets says about it.
local function show_message(frame, decoded, tvb, tree)
  local layout = decoded.layout
  local summary = layout.access .. " " .. layout.message.name .. " " .. layout.kind
  tree:append_text(", " .. summary .. (layout.sender and " from the " .. layout.sender or ""))
  tree:add(known.message, layout.message.name)
  tree:add(known.access, layout.access)
  tree:add(known.kind, layout.kind)
  if decoded.addressing.mode then tree:add(known.addressing, decoded.addressing.mode.name) end
  add_identifier(tree, frame, decoded)
  add_selectors(tree, tvb, decoded)
  local refused = refusal(decoded)
  local texts = { refused }
  for _, reading in ipairs(refused and {} or decoded.readings) do
    if not reading.is_hidden then
      table.insert(texts, reading.signal.name .. " " .. add_reading(tree, tvb, reading))
    end
  end
  if refused then tree:append_text(", " .. refused) end
  if decoded.reserved then tree:add(known.reserved, tvb(), decoded.reserved) end
  for _, note in ipairs(decoded.notes) do
    if not (refused and OF_VALUES[note.rule]) then tree:add_proto_expert_info(notes[note.rule], note.text) end
  end
  add_links(tree, frame, decoded)
  return #texts > 0 and summary .. ": " .. table.concat(texts, ", ") or summary
end

-- Adds what joined data show before the signals. It returns what stands in place of these if an error is reported.
local function show_joined(whole, tvb, tree)
  local layout, noted = whole.layout, {}
  local decoded = { layout = layout, notes = noted, selectors = selectors(whole.beginning, layout.selectors) }
  error_notes(whole.beginning, decoded, function(rule, text) table.insert(noted, { rule = rule, text = text }) end)
  tree:add(known.access, layout.access)
  tree:add(known.kind, layout.kind)
  add_selectors(tree, tvb, decoded)
  return refusal(decoded)
end

-- Adds a message that several frames carry. The last of them shows it.
local function show_whole(whole, model, tree)
  local name, data = whole.long.message.name, whole.data:gsub("%.", "0")
  local tvb = ByteArray.new(data):tvb("Joined data of " .. name)
  local subtree = tree:add(known.whole, tvb(), name)
  local refused = whole.layout and show_joined(whole, tvb, subtree)
  local readings, found = readings_of(whole, model)
  if refused then
    subtree:append_text(", " .. refused)
    readings, found = {}, {}
  end
  for _, reading in ipairs(readings) do
    if not reading.is_hidden then add_reading(subtree, tvb, reading) end
  end
  for _, note in ipairs(found) do subtree:add_proto_expert_info(notes[note.rule], note.text) end
  if whole.incomplete then subtree:add_proto_expert_info(incomplete, whole.incomplete) end
end

-- The messages that each frame ends.
local wholes

proto.init = function()
  forget_links()
  forget_parts()
  forget_transfers()
  forget_messages()
  wholes = {}
end

-- Notes a frame when it is seen for the first time. That can be in the second pass, because tshark's first pass may have
-- no fields.
local function notice(frame, decoded)
  if wholes[frame.number] then return end
  wholes[frame.number] = {}
  link(frame, decoded)
  take_part(frame, decoded, wholes[frame.number])
  take_transfer(frame, decoded, wholes[frame.number])
end

local function show(frame, decoded, tvb, pinfo, tree)
  pinfo.cols.protocol = string.upper(protocol.name)
  local root = tree:add(proto, tvb())
  if decoded.problem then
    show_problem(frame, decoded, tvb, root)
    return
  end
  notice(frame, decoded)
  local info = show_message(frame, decoded, tvb, root)
  for _, whole in ipairs(wholes[frame.number]) do
    show_whole(whole, frame.model, root)
    info = info .. (whole.incomplete and ", part of " or ", whole ") .. whole.long.message.name
  end
  pinfo.cols.info = info
end

local can_id, can_extended, can_remote = Field.new("can.id"), Field.new("can.flags.xtd"), Field.new("can.flags.rtr")
local fd_switch, interface_id, frame_time =
  Field.new("canfd.flags.brs"), Field.new("frame.interface_id"), Field.new("frame.time_epoch")

-- Returns the last value of a field of the earlier dissectors.
local function last(field)
  local all = { field() }
  if #all > 0 then return all[#all].value end
end

-- Returns a complete classic data frame, or nil for any other.
local function read_frame(tvb, pinfo)
  local length = tvb:len()
  if length > 8 or length < tvb:reported_len() or last(can_remote) ~= false or fd_switch() then return nil end
  local frame = { id = last(can_id), extended = last(can_extended), length = length, model = proto.prefs.model }
  frame.number, frame.time, frame.interface = pinfo.number, last(frame_time), tostring(last(interface_id) or 0)
  -- The data bytes as two numbers, filled up with zeros: byte 0 highest, and byte 0 lowest.
  frame.big, frame.little = UInt64(0), UInt64(0)
  if length > 0 then
    frame.big, frame.little = tvb():uint64():lshift(8 * (8 - length)), tvb():le_uint64()
  end
  return frame
end

-- If "Decode As" chose the dissector, it shows every frame, and says why one is not recognised.
function proto.dissector(tvb, pinfo, tree)
  local frame = read_frame(tvb, pinfo)
  if not frame then return 0 end
  show(frame, decode(frame), tvb, pinfo, tree)
  -- 0 would mean that the frame is another dissector's.
  return math.max(tvb:len(), 1)
end

DissectorTable.get("can.subdissector"):add_for_decode_as(proto)

-- If no dissector was chosen for a frame, this one shows it if it recognises it.
proto:register_heuristic("can", function(tvb, pinfo, tree)
  local frame = read_frame(tvb, pinfo)
  local decoded = frame and decode(frame)
  if not decoded or decoded.problem then return false end
  show(frame, decoded, tvb, pinfo, tree)
  return true
end)
