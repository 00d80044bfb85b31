"""Stands for bridges/ros/node.py where there is no ROS.

Begins with the arguments of that program, after the folder of helper.py. What
is published on a topic is the error with which it is refused: its kind in the
field `error`, and its other fields. A subscriber gets the arguments.
"""

import sys

sys.path.insert(0, sys.argv[1])
from helper import Helper, Refusal      # noqa: E402


class Node(Helper):
    def do_frame(self, request, _deadline):
        frame = request['frame']
        if frame['op'] == 'publish':
            fields = dict(frame['msg'])
            raise Refusal(fields.pop('error'), 'why', **fields)
        if frame['op'] == 'subscribe':
            message = {'arguments': sys.argv[3:]}
            self.event('frame', frame={'op': 'publish', 'msg': message,
                                       'topic': frame['topic']})
        return {}


Node().run()
