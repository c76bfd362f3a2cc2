-- Long messages: what several frames say together.
--
-- Joined data are hexadecimal digits, with two points for each byte that did not come.

-- Returns how many bytes a long message has at least if it has a signal. `count` is the length of a text that varies.
local function reach(signal, count)
  if not signal.most then return signal.window + signal.place.first + signal.place.count end
  local is_open = count and signal.least < signal.most
  return signal.window + (is_open and math.max(signal.least, math.min(count, signal.most)) or signal.most)
end

-- Tests whether a signal is there if arrays of varying length have `count` elements.
local function is_among(signal, count)
  return not count or not signal.index or signal.index < count
end

-- Returns the signals of a long message. `layout` is the kind of frame, if constants stand in the joined data.
local function signals_of(long, layout)
  return layout and layout.bare and {} or long.signals
end

-- Returns how many bytes a long message has with some number of elements, or with all.
local function bytes_with(long, count, layout)
  local bytes = layout and layout.head or 0
  for _, signal in ipairs(signals_of(long, layout)) do
    if is_among(signal, count) then bytes = math.max(bytes, reach(signal, count)) end
  end
  return bytes
end

local function longest(long)
  return long.lengths and long.lengths[#long.lengths] or bytes_with(long)
end

-- Returns how many bytes reach to the end of the last field that is always there.
local function least(long)
  return long.lengths and long.lengths[1] or bytes_with(long, 0)
end

-- Returns the numbers of bytes that a long message can have, the least first.
local function all_lengths(long, layout)
  local is_bare = #signals_of(long, layout) == 0
  if is_bare or not (long.lengths or long.elements) then return { bytes_with(long, nil, layout) } end
  if long.lengths then return long.lengths end
  local lengths = {}
  for count = long.elements[1], long.elements[2] do
    local length = bytes_with(long, count, layout)
    if length ~= lengths[#lengths] then table.insert(lengths, length) end
  end
  return lengths
end

-- Writes a number of bytes.
local function in_bytes(count)
  return count .. (count == 1 and " byte" or " bytes")
end

-- Says how many bytes a long message has, or returns nil if it can have `length`.
local function other_lengths(long, length, layout)
  local lengths = all_lengths(long, layout)
  for _, known in ipairs(lengths) do
    if known == length then return nil end
  end
  local first, last = lengths[1], lengths[#lengths]
  if #lengths > 2 and last - first == #lengths - 1 then return first .. " to " .. last end
  if #lengths > 3 then return string.format("%d, %d, ... %d", first, lengths[2], last) end
  return table.concat(lengths, " or ")
end

-- Returns how many elements an array of varying length has in some number of bytes.
local function elements_in(long, length, layout)
  for count = long.elements and long.elements[2] or -1, 0, -1 do
    if bytes_with(long, count, layout) <= length then return count end
  end
end

-- Returns the number that sixteen digits write.
local function word(digits)
  return UInt64(tonumber(digits:sub(9), 16), tonumber(digits:sub(1, 8), 16))
end

-- Returns the bytes from which a signal is read, as if they were a frame.
local function window(data, signal, model)
  local digits = (data:gsub("%.", "0"):sub(2 * signal.window + 1) .. string.rep("0", 16)):sub(1, 16)
  local reversed = digits:reverse():gsub("(.)(.)", "%2%1")
  return { big = word(digits), little = word(reversed), length = 8, model = model }
end

-- Tests whether all bytes of a signal came.
local function came(data, signal)
  local place = signal.place
  local digits = data:sub(2 * (signal.window + place.first) + 1, 2 * reach(signal))
  return #digits == 2 * place.count and not digits:find("%.")
end

-- Returns the digits of a text that no place holds, if all its bytes came.
local function digits_of_text(whole, signal)
  local first, last = 2 * signal.window, 2 * reach(signal, whole.count)
  local digits = whole.data:sub(first + 1, last)
  local is_announced = whole.count and not whole.is_ended
  local least = is_announced and last - first or 2 * signal.least
  local is_there = #whole.data >= first and #digits >= least
  if is_there and not digits:find("%.") then return digits end
end

-- Returns what joined data say of a signal, if all its bytes came.
local function reading_of(whole, signal, model)
  if not signal.most then
    return came(whole.data, signal) and reading(window(whole.data, signal, model), signal)
  end
  local found = digits_of_text(whole, signal)
  return found and text_reading(signal, found, model)
end

-- Tests whether a device model has a signal whose number or length varies.
local function has_varying(long, model)
  for _, signal in ipairs(long.signals) do
    local is_open = signal.most and signal.least < signal.most
    if (signal.index or is_open) and not lacks(signal, model) then return true end
  end
  return false
end

-- Returns what joined data say: the signals whose bytes all came, and notes.
local function readings_of(whole, model)
  local found, notes = {}, {}
  for _, signal in ipairs(signals_of(whole.long, whole.layout)) do
    local known = is_among(signal, whole.count) and reading_of(whole, signal, model)
    if known then table.insert(found, known) end
    if known and known.rule then table.insert(notes, known) end
  end
  if not whole.is_counted and has_varying(whole.long, model) then
    local text = "nothing says how many of the " .. whole.long.varying .. " are real"
    table.insert(notes, { rule = "count", text = text })
  end
  return found, notes
end

-- Says which of the numbers are missing, or returns nil.
local function missing(numbers, one, several)
  if #numbers == 0 then return nil end
  if #numbers == 1 then return one .. " " .. numbers[1] .. " is missing" end
  return "the " .. several .. " " .. table.concat(numbers, ", ") .. " are missing"
end

for _, message in ipairs(protocol.messages) do
  local long = message.long
  if long then long.message = message end
  for _, layout in ipairs(long and long.via and long.via.layouts or {}) do
    layout.long, layout.message = long, message
  end
  for _, signal in ipairs(long and long.signals or {}) do
    prepare_signal(signal)
  end
  if long and long.parts then prepare(long.parts.data) end
  if long and long.parts and long.parts.length then prepare(long.parts.length) end
end
