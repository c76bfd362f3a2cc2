"""A language server as an editor drives it: messages of the Language Server Protocol through its pipes."""

import json
import subprocess
from pathlib import Path

NO_NETWORK = Path(__file__).parent / "no_network.cjs"
# Without this the server fetches a catalogue of schemas.
SETTINGS = {"yaml": {"schemaStore": {"enable": False}}}


class Server:
    """A language server for YAML that runs, with no way to the network."""

    def __init__(self, program):
        command = ["node", "--require", NO_NETWORK, program, "--stdio"]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.requests = 0
        self.diagnostics = {}
        self.request("initialize", processId=None, rootUri=None, capabilities={"workspace": {"configuration": True}})
        self.notify("initialized")

    def stop(self):
        self.request("shutdown")
        self.notify("exit")
        self.process.communicate(timeout=10)

    def open(self, path, text):
        """Opens a text that need not be in the file, and returns what the server finds wrong with it."""
        uri = path.as_uri()
        document = {"uri": uri, "languageId": "yaml", "version": 1, "text": text}
        self.notify("textDocument/didOpen", textDocument=document)
        while uri not in self.diagnostics:
            self.take(self.read())
        return self.diagnostics.pop(uri)

    def completion(self, path, place):
        return self.at("textDocument/completion", path, place)["items"]

    def hover(self, path, place):
        return self.at("textDocument/hover", path, place)["contents"]["value"]

    def at(self, method, path, place):
        return self.request(method, textDocument={"uri": path.as_uri()}, position=place)

    def request(self, method, **parameters):
        """Asks, and returns the answer."""
        self.requests += 1
        self.write({"id": self.requests, "method": method, "params": parameters})
        while True:
            message = self.read()
            if message.get("id") == self.requests and "method" not in message:
                return message["result"]
            self.take(message)

    def notify(self, method, **parameters):
        self.write({"method": method, "params": parameters})

    def take(self, message):
        """Keeps diagnostics, and tells the settings that the server asks for."""
        match message["method"]:
            case "textDocument/publishDiagnostics":
                self.diagnostics[message["params"]["uri"]] = message["params"]["diagnostics"]
            case "workspace/configuration":
                sections = [item["section"] for item in message["params"]["items"]]
                self.write({"id": message["id"], "result": [SETTINGS.get(section) for section in sections]})

    def write(self, message):
        content = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n" % len(content) + content)
        self.process.stdin.flush()

    def read(self):
        length = None
        while line := self.process.stdout.readline().strip():
            name, _, value = line.partition(b": ")
            if name == b"Content-Length":
                length = int(value)
        if length is None:
            raise EOFError("the server has ended")
        return json.loads(self.process.stdout.read(length))
