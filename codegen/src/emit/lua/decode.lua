-- Decoding: finds the message of a frame.

-- Addressing: finds the mode that an identifier shows.

local REQUEST, REPLIES = { "request" }, { "one", "each", "coordinator" }

-- Tests a pattern. It returns "documented", "tolerated" if the document does not name an address,
-- or nil.
local function pattern_fit(frame, pattern)
  if not shows(frame.id, pattern.constants) then return nil end
  local fit = "documented"
  for _, address in ipairs(pattern.addresses) do
    local kind, raw = protocol.address_types[address.type], identifier_field(frame, address.field)
    if not lies_within(raw, kind.ranges) then
      if kind.strict or lies_within(raw, address.excluded) then return nil end
      fit = "tolerated"
    end
  end
  return fit
end

-- Tests whether a kind of frame goes to a module.
local function is_to_module(layout)
  return layout.kind == "request" or layout.to_module == true
end

-- Calls `found` with each mode that the identifier shows, who answers, and how well the mode fits.
-- 1 is the best fit. From 3 on, the message does not have the mode.
local function each_mode(frame, layout, found)
  for _, mode in ipairs(protocol.modes) do
    for _, who in ipairs(is_to_module(layout) and REQUEST or REPLIES) do
      local pattern = mode[who]
      local fit = pattern and pattern_fit(frame, pattern)
      if fit then
        local answer = layout.answers[mode.name]
        local has = who == "request" and answer ~= nil or answer == who
        found(mode, who, (has and 0 or 2) + (fit == "documented" and 1 or 2))
      end
    end
  end
end

-- Returns the mode that fits best. Among equal modes it has the most constants.
local function addressing(frame, layout)
  local best = { fit = 5, constants = 0 }
  each_mode(frame, layout, function(mode, who, fit)
    local constants = mode[who].constant_fields
    if fit < best.fit or (fit == best.fit and constants > best.constants) then
      best = { fit = fit, constants = constants, mode = mode, pattern = mode[who] }
    end
  end)
  return best
end

-- Choosing: finds the one message of an identifier.

local function is_of_model(message, model)
  if not message.models or model == 0 then return true end
  for _, known in ipairs(message.models) do
    if known == model then return true end
  end
  return false
end

-- Tests whether no device model has both messages.
local function is_apart(one, other)
  if not one.models or not other.models then return false end
  for _, model in ipairs(one.models) do
    if is_of_model(other, model) then return false end
  end
  return true
end

local function holds(frame, alternatives)
  for _, tests in ipairs(alternatives) do
    local all = true
    for _, test in ipairs(tests) do
      all = all and lies_within(identifier_field(frame, test.field), test.ranges) == test.inside
    end
    if all then return true end
  end
  return false
end

local function is_foreign(frame)
  for _, tests in ipairs(protocol.foreign) do
    local all = true
    for _, test in ipairs(tests) do
      local value = test.field and identifier_field(frame, test.field) or frame.id
      all = all and test.first <= value and value <= test.last
    end
    if all then return true end
  end
  return false
end

local function filtered(layouts, test)
  local left = {}
  for _, layout in ipairs(layouts) do
    if test(layout) then left[#left + 1] = layout end
  end
  return left
end

-- Kinds of frames in the order of the plan, and the refusals. A refusal answers a request in place
-- of its reply. Each kind knows its message.
local kinds_of_frames, refusals = {}, {}
for _, message in ipairs(protocol.messages) do
  for _, signal in ipairs(message.signals) do prepare_signal(signal) end
  for _, layout in ipairs(message.layouts) do
    layout.message = message
    table.insert(kinds_of_frames, layout)
  end
  for _, refusal in ipairs(message.refusals or {}) do
    refusal.message = message
    table.insert(refusals, refusal)
  end
end
for _, selector in ipairs(protocol.selectors) do
  if selector.place then prepare(selector.place) end
end

-- Returns the layouts whose constants the identifier has.
local function with_identifier(frame, layouts)
  return filtered(layouts, function(layout)
    for _, constant in ipairs(layout.in_identifier) do
      if identifier_field(frame, constant.field) ~= constant.value then return false end
    end
    return true
  end)
end

-- Returns the layouts whose constants the data bytes have.
local function with_data(frame, layouts)
  local found = {}
  return filtered(layouts, function(layout)
    for _, constant in ipairs(layout.in_data) do
      local index = constant.selector
      found[index] = found[index] or key(get(frame, protocol.selectors[index].place))
      local is_other = constant.others and constant.others[found[index]]
      if found[index] ~= constant.value and not is_other then return false end
    end
    return true
  end)
end

-- Returns the values of payload selectors whose bytes the frame has.
local function selectors(frame, indices)
  local found = {}
  for _, index in ipairs(indices) do
    local selector = protocol.selectors[index]
    if has(frame, selector.place) then
      found[#found + 1] = { index = index, selector = selector, value = get(frame, selector.place) }
    end
  end
  return found
end

-- Says why a frame is not recognised, with the selectors that it could have.
local function problem(kind, text, frame, indices)
  return { problem = kind, text = text, selectors = indices and selectors(frame, indices) or {} }
end

-- Follows the plan for a frame to its outcome, or to nil.
local function find(frame, choice)
  while choice and choice.cases do
    local value
    if choice.field then
      value = identifier_field(frame, choice.field)
    else
      value = key(get(frame, protocol.selectors[choice.selector].place))
    end
    choice = choice.cases[value] or choice.otherwise
  end
  return choice
end

-- The same for an identifier without the fields of this protocol.
local function other_identifier(kind, text)
  return { problem = kind, text = text, selectors = {}, has_other_identifier = true }
end

local NO_DIRECTION = "the addresses do not show whether it goes to "
  .. (protocol.sides or "a module or to the controller")

-- Names the numbers of data bytes of the frames with an identifier.
local function lengths_of(group)
  local known = {}
  for length = 0, 8 do
    if group.lengths[length] then table.insert(known, length) end
  end
  return table.concat(known, " or ")
end

-- Returns the layouts with the identifier, the length and the data bytes of a frame, or a problem.
local function candidates(frame)
  local identifier = protocol.identifier
  if frame.extended ~= identifier.extended then
    return nil, other_identifier("identifier", "the identifier has another width")
  elseif is_foreign(frame) then
    return nil, other_identifier("foreign", "the identifier belongs to somebody else")
  elseif not shows(frame.id, identifier.constants) then
    return nil, problem("identifier", "the identifier's fixed bits are others")
  end
  local to_module, to_controller = holds(frame, protocol.to_module), holds(frame, protocol.to_controller)
  if not to_module and not to_controller then return nil, problem("identifier", NO_DIRECTION) end

  local is_told = to_module ~= to_controller
  local course = is_told and (to_module and protocol.requests or protocol.replies) or protocol.either
  local group = find(frame, course)
  if not group or not group.lengths then
    return nil, problem("unknown_message", "no message has this identifier")
  end

  local of_length = group.lengths[frame.length]
  if not of_length then
    local bytes = frame.length == 1 and " data byte instead of " or " data bytes instead of "
    local text = frame.length .. bytes .. lengths_of(group)
    return nil, problem("length", text, frame, group.selectors)
  end

  local found, chosen = find(frame, group.choice), {}
  for _, index in ipairs(found and found.frames or {}) do
    local layout = kinds_of_frames[index]
    if layout.lengths[frame.length] then chosen[#chosen + 1] = layout end
  end
  if #chosen == 0 then return nil, problem("unknown_message", "no message has these data bytes", frame, of_length) end
  return chosen
end

-- Tests whether the first of two layouts fits better, by device model and then by addresses.
local function compare(one, other)
  if one.is_of_model ~= other.is_of_model then return one.is_of_model end
  if one.fit ~= other.fit then return one.fit < other.fit end
  return one.constants > other.constants
end

local function rank(frame, layout)
  local known = addressing(frame, layout)
  return { is_of_model = is_of_model(layout.message, frame.model), fit = known.fit, constants = known.constants }
end

-- Names a message and the device models that have it.
local function of_models(message)
  local names = {}
  for index, model in ipairs(message.models) do names[index] = protocol.models[model] end
  return "`" .. message.name .. "` if the model is " .. table.concat(names, " or ")
end

-- Returns the layout that fits best, and a note if that depends on the device model.
local function best(frame, layouts)
  local chosen, ranked = layouts[1], rank(frame, layouts[1])
  for index = 2, #layouts do
    local other = rank(frame, layouts[index])
    if compare(other, ranked) then chosen, ranked = layouts[index], other end
  end
  local message = chosen.message
  if frame.model ~= 0 then
    if is_of_model(message, frame.model) then return chosen end
    return chosen, protocol.models[frame.model] .. " has no message `" .. message.name .. "`"
  end
  local others = {}
  for _, layout in ipairs(layouts) do
    local other = rank(frame, layout)
    if is_apart(message, layout.message) and not compare(other, ranked) and not compare(ranked, other) then
      local text = of_models(layout.message)
      if others[#others] ~= text then others[#others + 1] = text end
    end
  end
  return chosen, #others > 0 and "it is " .. table.concat(others, ", and ") or nil
end

-- Notes: what the document does not foresee.

local function error_note(field, value)
  local name = field.names and field.names[key(value)]
  return field.name .. " " .. plain(value) .. (name and ": " .. name or ", which the document does not name")
end

local function error_notes(frame, decoded, note)
  for index, field in ipairs(protocol.identifier.fields) do
    local value = identifier_field(frame, index)
    if field.normal and field.normal ~= value then note("error_code", error_note(field, value)) end
  end
  if is_to_module(decoded.layout) then return end
  for _, known in ipairs(decoded.selectors) do
    local normal = known.selector.normal
    if normal and normal ~= key(known.value) then note("error_code", error_note(known.selector, known.value)) end
  end
end

local function address_notes(frame, decoded, note)
  local known = decoded.addressing
  if not known.mode then
    note("addressing", "no addressing mode of this protocol fits a " .. decoded.layout.kind)
    return
  end
  if known.fit >= 3 then
    note("addressing", "`" .. decoded.layout.message.name .. "` is not addressed by `" .. known.mode.name .. "`")
  end
  for _, address in ipairs(known.pattern.addresses) do
    local kind, raw = protocol.address_types[address.type], identifier_field(frame, address.field)
    if not lies_within(raw, kind.ranges) then
      local ranges = {}
      for _, range in ipairs(kind.ranges) do
        local first, last = hexadecimal(range[1]), hexadecimal(range[2])
        table.insert(ranges, first == last and first or first .. ".." .. last)
      end
      local field, named = protocol.identifier.fields[address.field].name, table.concat(ranges, ", ")
      note("address", field .. " " .. hexadecimal(raw) .. " is outside " .. named .. " of `" .. kind.name .. "`")
    end
  end
end

-- Returns the number of the first part, if it is known of the device model.
local function first_part(parts, model)
  return parts.first or parts.firsts[model]
end

-- Returns the message with its values and notes, or a problem.
local function decode(frame)
  local layouts, unrecognised = candidates(frame)
  if not layouts then return unrecognised end
  local layout, other_model = best(frame, layouts)
  local decoded = { layout = layout, notes = {}, readings = {}, selectors = selectors(frame, layout.selectors) }
  local function note(rule, text) table.insert(decoded.notes, { rule = rule, text = text }) end
  decoded.addressing = addressing(frame, layout)
  error_notes(frame, decoded, note)
  address_notes(frame, decoded, note)
  for _, index in ipairs(layout.signals) do
    local signal = layout.message.signals[index]
    if has(frame, signal.place) then
      local known = reading(frame, signal)
      table.insert(decoded.readings, known)
      if known.rule then note(known.rule, known.text) end
    end
  end
  local parts = layout.message.long and layout.message.long.parts
  if parts and #decoded.readings > 0 and not first_part(parts, frame.model) then
    note("model_dependent", "the first part of `" .. layout.message.name .. "` has another number on each model")
  end
  local reserved = frame.big:band(layout.reserved):tohex(-16):sub(1, 2 * frame.length)
  if reserved:find("[^0]") then decoded.reserved = reserved end
  local odd = frame.big:band(layout.reserved):bxor(layout.filled):tohex(-16):sub(1, 2 * frame.length)
  if odd:find("[^0]") and not layout.free then
    local found = layout.filled == UInt64(0) and "set" or "clear"
    note("reserved_bit", "bits are " .. found .. " that no field has: 0x" .. odd)
  end
  if other_model then note("model_dependent", other_model) end
  return decoded
end

-- Returns what a frame that reports an error says in place of its values, or nil for any other
-- frame.
local function refusal(decoded)
  if is_to_module(decoded.layout) then return nil end
  for _, note in ipairs(decoded.notes) do
    if note.rule == "error_code" then return (decoded.layout.kind == "reply" and "refused, " or "in error, ") .. note.text end
  end
end
