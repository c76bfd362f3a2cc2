-- Linking: finds the request that a reply answers, and how long that took.

local waiting, requests, responses

local function forget_links()
  waiting, requests, responses = {}, {}, {}
end

-- Returns the value of the same kind of address in a pattern's identifier.
local function bound(frame, pattern, kind)
  for _, address in ipairs(pattern.addresses) do
    if address.type == kind then return identifier_field(frame, address.field) end
  end
end

-- Returns what a request and its reply share. `pattern` is what this frame shows.
local function exchange(frame, layout, mode, who, pattern)
  local parts = { frame.interface, layout.exchange or layout.message.name, layout.access, mode.name, who }
  for _, address in ipairs(mode[who].addresses) do
    if bound(frame, mode.request, address.type) then
      table.insert(parts, string.format("%d", bound(frame, pattern, address.type)))
    end
  end
  return table.concat(parts, " ")
end

-- Returns who answers a request, or nil if nobody does or the document does not say it.
local function answering(decoded)
  local known, layout = decoded.addressing, decoded.layout
  if layout.kind ~= "request" or known.fit >= 3 then return nil end
  local who = layout.answers[known.mode.name]
  return known.mode[who] and who
end

local function ask(frame, decoded)
  local known, who = decoded.addressing, answering(decoded)
  if not who then return end
  waiting[exchange(frame, decoded.layout, known.mode, who, known.pattern)] =
    { number = frame.number, time = frame.time, senders = {} }
end

-- Returns the addresses of a reply, which identify its sender.
local function sender(frame, pattern)
  local parts = {}
  for _, address in ipairs(pattern.addresses) do
    table.insert(parts, string.format("%d", identifier_field(frame, address.field)))
  end
  return table.concat(parts, " ")
end

-- Calls `found` with each request that still waits for a reply of this layout, and with what the
-- reply's sender has sent so far.
local function each_request(frame, layout, found)
  each_mode(frame, layout, function(mode, who, fit)
    if fit >= 3 or not mode.request then return end
    local this = exchange(frame, layout, mode, who, mode[who])
    local request = waiting[this]
    if not request then return end
    local from = sender(frame, mode[who])
    request.senders[from] = request.senders[from] or { messages = {}, count = 0 }
    local sent = request.senders[from]
    if not sent.is_done then found({ request = request, key = this, who = who, sent = sent, layout = layout }) end
  end)
end

-- Notes a reply. A module is done when it has sent all messages of a set, or one message, or has
-- refused.
local function note_reply(known, is_refusal)
  local sent, name = known.sent, known.layout.message.name
  if not sent.messages[name] then
    sent.messages[name], sent.count = true, sent.count + 1
  end
  sent.is_done = is_refusal or sent.count >= (known.layout.replies or 1)
  if sent.is_done and known.who ~= "each" then waiting[known.key] = nil end
end

-- Finds the latest request that a frame replies to, or refuses.
local function answer(frame, decoded)
  local latest, is_refusal
  local function choose(refuses)
    return function(known)
      if not latest or known.request.number > latest.request.number then
        latest, is_refusal = known, refuses
      end
    end
  end
  each_request(frame, decoded.layout, choose(false))
  for _, refusal in ipairs(with_data(frame, with_identifier(frame, refusals))) do
    each_request(frame, refusal, choose(true))
  end
  if not latest then return end
  note_reply(latest, is_refusal)
  local request = latest.request
  requests[frame.number] = { number = request.number, time = frame.time - request.time }
  responses[request.number] = responses[request.number] or {}
  table.insert(responses[request.number], frame.number)
end

-- Notes a frame.
local function link(frame, decoded)
  if decoded.layout.kind == "request" then ask(frame, decoded) end
  if decoded.layout.kind == "reply" then answer(frame, decoded) end
end
