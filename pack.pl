% `make release URL=...` adds home/1, download/1 and packager/2.
pack_version(2).
name(typhon).
version('0.3.0').
title('Mobile agents that travel in the middle of a clause').
description([ 'A mobile-agent platform: agents are Prolog programs that stop in',
              'the middle of a clause, travel to another process or machine',
              'with their state and their messages, and continue there.',
              'Networks of hosts, virtual time, journal, TLS, bridges to',
              'Python, MQTT, ROS, FIPA and LEGO NXT.'
            ]).
keywords([agent, mobile, distributed, robot, network]).
author('The Typhon developers', '').
requires(prolog >= '9.0.4').
