:- module(typhon_commands,
          [ command/4,                  % ?Command, ?Arguments, ?Count, ?Help
            option/5                    % ?Command, ?Option, ?Type, ?Meta, ?Help
          ]).

/** <module> The commands and options of the command line

*Threading*: facts only.
*/

%!  command(?Command, ?Arguments, ?Count, ?Help) is nondet.
%
%   Count is the number of Arguments, or Min-Max.

command(host, 'NAME', 1,
        'start a host and run it until SIGTERM or SIGINT').
command(network, 'TOPOLOGY', 1,
        'start a network, as grid(2,3), and run it until Ctrl-C').
command(create, 'PROGRAM', 1,
        'create an agent on a running host; prints its id').
command(agents, '', 0,
        'the agents known to the process of a running host').
command(hosts, '', 0,
        'the hosts of the process of a running host').
command(send, 'AGENT MESSAGE', 2,
        'send a message, any term, to an agent').
command(log, 'FILE', 1,
        'print the events of a log file, or with --serve write one').
command(diagnose, '[ADDRESS]', 0-2,
        'find out why a host, or with nxt PORT a robot, is not reached').

%!  option(?Command, ?Option, ?Type, ?Meta, ?Help) is nondet.
%
%   Type is one of argv_options/3, Meta what stands for the value in the
%   help.

option(host, port, nonneg, 'PORT',
       'TCP port (default any free one)').
option(host, bind, atom, 'INTERFACE',
       'interface to listen at (default localhost)').
option(host, capacity, nonneg, 'N',
       'admit that many agents').
option(host, tokens, atom, 'A,B',
       'admit only agents with one of these tokens').
option(host, consult, file(read), 'FILE',
       'clauses for the place of the host (may be repeated)').
option(host, log, atom, 'ADDRESS',
       'log server to report to').
option(host, link, atom, 'ADDRESS',
       'host to link to (may be repeated)').
option(network, processes, natural, 'N',
       'spread the hosts over N processes').
option(network, bind, atom, 'INTERFACE',
       'interface to listen at (default localhost)').
option(network, seed, integer, 'N',
       'seed of everything random').
option(network, log, atom, 'FILE',
       'write the events of all hosts to FILE').
option(network, machines, atom, 'A,B',
       'ssh targets to start the processes on').
option(network, dynamic, term, 'MODEL',
       'model by which links come and go').
option(network, hop_time, term, 'uniform(A,B)',
       'delay added to every hop, in host seconds').
option(network, clock, number, 'RATE',
       'host seconds in a real second').
option(create, host, atom, 'ADDRESS',
       'host to create it on (required)').
option(create, name, atom, 'NAME',
       'name its id is made from').
option(create, tokens, atom, 'A,B',
       'tokens it carries').
option(create, payload, atom, 'FILE',
       'payload it carries (may be repeated)').
option(create, fact, term, 'FACT',
       'fact added to its state (may be repeated)').
option(create, lifetime, nonneg, 'HOPS',
       'number of hops it may make').
option(create, static, boolean, '',
       'it may not move').
option(create, join, number, 'SECONDS',
       'wait for its end, print the outcome').
option(agents, host, atom, 'ADDRESS', 'host to ask (required)').
option(hosts, host, atom, 'ADDRESS', 'host to ask (required)').
option(send, host, atom, 'ADDRESS',
       'host that finds the agent (default its home)').
option(log, host, atom, 'ADDRESS',
       'read FILE where this host runs').
option(log, serve, boolean, '',
       'be the log server that writes FILE').
option(log, port, nonneg, 'PORT',
       'port of the log server (default any free one)').
option(log, bind, atom, 'INTERFACE',
       'interface of the log server (default localhost)').
