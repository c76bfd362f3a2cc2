-- Linking: which request a reply answers, and how long that took.

local waiting, requests, responses, seen

local function forget()
  waiting, requests, responses, seen = {}, {}, {}, {}
end
forget()

-- Returns the value of the same kind of address in a pattern's identifier.
local function bound(frame, pattern, kind)
  for _, address in ipairs(pattern.addresses) do
    if address.type == kind then return identifier_field(frame, address.field) end
  end
end

-- Returns what a request and its reply have in common; `pattern` is what the frame at hand shows.
local function exchange(frame, shape, mode, who, pattern)
  local parts = { frame.interface, shape.message.name, shape.access, mode.name, who }
  for _, address in ipairs(mode[who].addresses) do
    if bound(frame, mode.request, address.type) then
      table.insert(parts, string.format("%d", bound(frame, pattern, address.type)))
    end
  end
  return table.concat(parts, " ")
end

-- Returns who answers a request; nil if nobody does, or if the document does not say.
local function answering(decoded)
  local known, shape = decoded.addressing, decoded.shape
  if shape.kind ~= "request" or known.fit >= 3 then return nil end
  local who = shape.answers[known.mode.name]
  return known.mode[who] and who
end

local function ask(frame, decoded)
  local known, who = decoded.addressing, answering(decoded)
  if not who then return end
  waiting[exchange(frame, decoded.shape, known.mode, who, known.pattern)] =
    { number = frame.number, time = frame.time, answered = {} }
end

-- Calls `found` with each request that still waits for a reply of this shape.
local function each_request(frame, shape, found)
  each_mode(frame, shape, function(mode, who, fit)
    if fit >= 3 or not mode.request then return end
    local this = exchange(frame, shape, mode, who, mode[who])
    local request = waiting[this]
    if request and not request.answered[frame.id] then found(request, this, who) end
  end)
end

-- Finds the latest request that a frame replies to, or refuses; each module answers a group's once.
local function answer(frame, decoded)
  local latest, latest_key, latest_who
  local function choose(request, this, who)
    if not latest or request.number > latest.number then
      latest, latest_key, latest_who = request, this, who
    end
  end
  each_request(frame, decoded.shape, choose)
  for _, refusal in ipairs(with_data(frame, with_identifier(frame, refusals))) do
    each_request(frame, refusal, choose)
  end
  if not latest then return end
  latest.answered[frame.id] = true
  if latest_who ~= "each" then waiting[latest_key] = nil end
  requests[frame.number] = { number = latest.number, time = frame.time - latest.time }
  responses[latest.number] = responses[latest.number] or {}
  table.insert(responses[latest.number], frame.number)
end

-- Notes a frame when it is seen for the first time. That can be in the second pass: tshark's first one may have no fields.
local function link(frame, decoded)
  if seen[frame.number] then return end
  seen[frame.number] = true
  if decoded.shape.kind == "request" then ask(frame, decoded) end
  if decoded.shape.kind == "reply" then answer(frame, decoded) end
end
