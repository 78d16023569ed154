"""How a peer is told what to do: a JSON object a line comes in, what happens goes out likewise."""

import json
import sys
import threading
import time

lock = threading.Lock()


def say(**what):
    with lock:
        print(json.dumps(what), flush=True)


def obey(peer, then=lambda: None):
    """Calls what each line names, one after the other, until there are no more."""
    say(up=True)
    for line in sys.stdin:
        said = json.loads(line)
        getattr(peer, said.pop("do"))(**said)
        then()
        say(done=True)


def repeat(send, message, count, rate):
    """Sends a message again and again, meanwhile."""
    def run():
        for _ in range(count):
            send(message)
            if count > 1:
                time.sleep(1.0 / rate)

    threading.Thread(target=run, daemon=True).start()
