#!/usr/bin/env python3
"""A controller outside the gateway, in the shape that a learnt one would have: observation in, action out.

Drives to a point and levels the machine by its strokes. Run it beside one of

    xt28 run straight-25m --policy rosbridge:9090
    gateway --bus vcan0 --gnss /tmp/gnss --policy rosbridge:9090

    python3 controller.py --port 9090 --east 25

It needs roslibpy alone (pip install roslibpy). docs/rosbridge.md has every field of the messages.
"""

import argparse
import math
import sys
import threading

STROKE_MAX_M = 0.25
JOINT_MAX_RAD = math.radians(25.0)
MIDDLE_M = 0.17


def act(seen, east_m):
    """Eight numbers from -1 to 1: throttle, front joint, strokes FR FL MR ML BR BL."""
    here = seen["located"]
    if here is None:
        return [0.0, 0.0] + [stroke_action(stroke) for stroke in seen["stroke_m"]]
    left_m = east_m - here["east_m"]
    throttle = max(-0.3, min(0.6, 0.4 * left_m))
    # Back to the line north = 0, the more gently the further it is.
    heading = math.atan2(-here["north_m"], 6.0) - here["heading_rad"]
    joint = max(-1.0, min(1.0, 1.5 * heading / JOINT_MAX_RAD))
    # Right side high: its arms shorter. Nose up: the front ones.
    right, front = -0.6 * seen["roll_rad"], -0.8 * seen["pitch_rad"]
    lift = [(right + front), (-right + front), right, -right, (right - front), (-right - front)]
    return [throttle, joint] + [stroke_action(MIDDLE_M + metres) for metres in lift]


def stroke_action(stroke_m):
    return 2.0 * max(0.0, min(STROKE_MAX_M, stroke_m)) / STROKE_MAX_M - 1.0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--port", type=int, default=9090)
    parser.add_argument("--east", type=float, default=25.0, help="where to, m east of the origin")
    args = parser.parse_args()
    import roslibpy  # here, so that imitate.py has act() without it

    ros = roslibpy.Ros(args.host, args.port)
    try:
        ros.run(timeout=30)
    except roslibpy.core.RosTimeoutError:
        sys.exit(f"nothing listens at ws://{args.host}:{args.port}; start the gateway or `xt28 run` first")
    action = roslibpy.Topic(ros, "/xt28/action", "xt28_msgs/Action")
    finish = roslibpy.Service(ros, "/xt28/finish", "std_srvs/SetBool")
    over = threading.Event()

    def on_observation(seen):
        if over.is_set():
            return
        here = seen["located"]
        if here is not None and abs(args.east - here["east_m"]) < 0.15 and abs(seen["speed_m_s"]) < 0.05:
            # Said before the answer, so that the machine holds from this observation on, and not waited for: this
            # thread is the one that would hear the response. Refused until a first answer was taken.
            finish.call(roslibpy.ServiceRequest({"data": True}), lambda _: over.set(), lambda _: None)
        action.publish({"seq": seen["seq"], "action": act(seen, args.east)})

    roslibpy.Topic(ros, "/xt28/observation", "xt28_msgs/Observation").subscribe(on_observation)
    gone = threading.Event()
    ros.on("close", lambda _: gone.set())
    try:
        gone.wait()
    except KeyboardInterrupt:
        pass
    ros.terminate()
    return 0 if over.is_set() else 1


if __name__ == "__main__":
    sys.exit(main())
