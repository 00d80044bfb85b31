:- module(typhon_commands,
          [ command/4,                  % ?Command, ?Arguments, ?Count, ?Help
            footer/2,                   % ?Command, ?Line
            option/5                    % ?Command, ?Option, ?Type, ?Meta, ?Help
          ]).

:- use_module(engine_options, [engine_option/4]).

/** <module> The commands and options of the command line

*Threading*: facts only.
*/

:- use_module(library(lists), [member/2]).

%!  command(?Command, ?Arguments, ?Count, ?Help) is nondet.
%
%   Count is the number of Arguments, or Min-Max.

command(host, 'NAME', 1,
        'start a host and run it until SIGTERM, SIGHUP or SIGINT').
command(network, 'TOPOLOGY', 1,
        'start a network, such as grid(2,3), and run it until Ctrl-C').
command(check, 'PROGRAM ...', 1-1000,
        'check agent programs and payloads for errors').
command(create, 'PROGRAM', 1,
        'create an agent on a running host, and print its id').
command(agents, '', 0,
        'list the agents in the network of a running host').
command(hosts, '', 0,
        'list the hosts in the network of a running host').
command(tree, '', 0,
        'list supervisors, their children, and other monitored agents').
command(send, 'AGENT MESSAGE', 2,
        'send a message, any term, to an agent').
command(move, 'AGENT HOST', 2,
        'move an agent to a host, and wait until it has arrived').
command(dispose, 'AGENT', 1,
        'end an agent').
command(join, 'AGENT', 1,
        'wait for the end of an agent, and print its outcome').
command(remote, 'HOST GOAL', 2,
        'run a goal in the place of a host, and print its bindings').
command(stop, 'HOST', 1,
        'stop a host, and wait until it has stopped').
command(log, 'FILE', 1,
        'print the events of a log file, or with --serve write a log file').
command(story, 'LOG AGENT', 2,
        'print the history of an agent from a log').
command(picture, 'LOG SVG', 2,
        'draw a log: hosts, time, agents and messages').
command(page, '[LOG]', 0-1,
        'show the network of a running host in a browser, or replay a log').
command(fleet, 'hosts | where AGENT | park ... | drain HOST | here HOST', 1-3,
        'hosts, agents, and what is parked in a fleet').
command(journal, 'DIR', 1,
        'show the journal of a stopped process or network').
command(keys, 'init | host NAME | author NAME | revoke NAME', 1-2,
        'make an authority, make or revoke keys for hosts and authors').
command(sign, 'PROGRAM', 1,
        'sign an agent program, for hosts that require authors').
command(diagnose, '[ADDRESS]', 0-2,
        'diagnose why a host, or with nxt PORT a robot, is unreachable; or \c
         why python, gpio, mqtt URL, fipa URL, ros or ros URL does not work').

%!  footer(?Command, ?Line) is nondet.
%
%   Line is a line at the end of the help of Command.

footer(host, 'Exit status 0: stopped in order; 1: an error; 75: another').
footer(host, 'process has its journal. If it does not stop in time it kills').
footer(host, 'itself, which is 137 in a shell.').
footer(network, 'Shapes of networks:').
footer(network, Line) :-
    shape(Shape, Help),
    format(atom(Line), '    ~w~t~28|~w', [Shape, Help]).
footer(network, 'With the same --journal a restarted network continues.').
footer(check, 'Exit status 0: no program has errors; there may be warnings.').
footer(join, 'Exit status 0: the outcome is `done`.').
footer(remote,
       'Exit status 0: the goal succeeded. Output of the goal is printed.').
footer(remote, 'Variables that begin with _ are not printed.').
footer(page, 'Prints the link, which authorizes all orders of the page. Runs until').
footer(page, 'SIGTERM, SIGHUP or SIGINT. With LOG it writes a file for a browser.').
footer(keys,
       'Copy DIR/NAME to the machine of NAME: host_start(H, [tls(DIR)]).').
footer(fleet, Line) :-
    member(What-Help,
           [ hosts-'hosts of the fleet, and since when they are up or away',
             'where AGENT'-'the host on which the agent is',
             'park list'-'agents that wait for hosts that are away',
             'park drop AGENT'-'it goes on where it was',
             'park send AGENT'-'send it to its host now',
             'drain HOST'-'its agents go elsewhere, and it leaves; prints \c
                           those that stay',
             'here HOST'-'exit status 0: others find the host in its fleet',
             'alive HOST'-'exit status 0: a worker of its process takes a turn' ]),
    format(atom(Line), '    ~w~t~28|~w', [What, Help]).
footer(fleet, 'drain, here and alive ask the process of HOST, an address; they need no').
footer(fleet, '--fleet, and alive no engine.').
footer(stop, 'A command `host` or `network` ends with its host.').
footer(Command, 'AGENT is an id, as in `agents`, or with --host a name.') :-
    memberchk(Command, [send, move, dispose, join]).
footer(move, 'HOST is an address, or a name if that is unique.').

shape('ring(N)', 'a ring').
shape('line(N)', 'a line').
shape('star(N)', 'one host in the middle, N-1 around it').
shape('star_bus(ARMS,LENGTH)',
      'a chain of ARMS hubs, each with LENGTH-1 leaves').
shape('tree(N)', 'a binary tree').
shape('grid(ROWS,COLUMNS)', 'a grid').
shape('mesh(N)', 'all pairs linked').
shape('random(N,P)', 'each pair linked with probability P').
shape('edges([1-2,2-3,...])', 'the links themselves').

%!  option(?Command, ?Option, ?Type, ?Meta, ?Help) is nondet.
%
%   Type is a type of argv_options/3, Meta the name of the value in the help.

option(host, port, nonneg, 'PORT',
       'TCP port (default any free one)').
option(host, bind, atom, 'INTERFACE',
       'interface to listen at (default localhost)').
option(Command, advertise, atom, 'ADDRESS',
       'name or address, if not that of --bind, by which peers reach it') :-
    memberchk(Command, [host, network, log]).
option(host, capacity, nonneg, 'N',
       'maximum number of agents').
option(host, authors, atom, 'A,B',
       'admit only programs signed by one of these authors').
option(host, tokens, atom, 'A,B',
       'admit only agents with one of these tokens').
option(host, policy, atom, 'P',
       'guarded or a file of rules: run agents in cells, under these rules').
option(host, consult, file(read), 'FILE',
       'clauses for the place of the host (may be repeated)').
option(host, log, atom, 'ADDRESS',
       'log server to report to').
option(host, events, atom, 'A,B',
       'with --log: also hops, messages, messages(content), facts').
option(host, link, atom, 'ADDRESS',
       'host to link to (may be repeated)').
option(host, mqtt, atom, 'URL',
       'MQTT broker for its agents, such as mqtt://localhost').
option(host, journal, atom, 'DIR',
       'keep the state of the process in DIR, at a postgresql:// URL, or with \c
        --fleet in redis').
option(host, fleet, atom, 'FLEET',
       'fleet of the host; its agents go elsewhere when it stops').
option(Command, Option, Type, Meta, Help) :-
    memberchk(Command, [host, fleet, journal]),
    engine_option(Option, Type, Meta, Help).
option(host, tags, atom, 'A,B',
       'with --fleet: what any(Tag) finds the host by').
option(host, stop_seconds, number, 'SECONDS',
       'time to stop, before the process is killed (default 60)').
option(host, sync, atom, 'HOW',
       'with --journal: normal or, to survive a power cut, full').
option(fleet, fleet, atom, 'FLEET',
       'fleet to ask').
option(fleet, tag, atom, 'A,B',
       'hosts: only those with all of these tags').
option(fleet, away, boolean, '',
       'hosts: only those that are away').
option(fleet, to, atom, 'A,B',
       'drain: to hosts with all of these tags (default its first tag)').
option(fleet, timeout, number, 'SECONDS',
       'seconds to wait: drain, for agents (default 60); alive (default 10)').
option(network, journal, atom, 'DIR',
       'keep the state of the processes below DIR or at a \c
        postgresql:// URL').
option(network, sync, atom, 'HOW',
       'with --journal: normal or, to survive a power cut, full').
option(network, restart, boolean, '',
       'restart processes that die').
option(Command, tls, atom, 'DIR',
       'keys: use TLS, with processes that have keys of the same authority') :-
    command(Command, _, _, _),
    \+ memberchk(Command, [keys, sign, check, story, picture, journal]).
option(Command, dir, atom, 'DIR',
       'directory of the authority (default keys)') :-
    memberchk(Command, [keys, sign]).
option(sign, author, atom, 'NAME',
       'author that signs (required)').
option(keys, days, natural, 'N',
       'host, author: days until the certificate expires (default 825)').
option(network, processes, natural, 'N',
       'spread the hosts over N processes').
option(network, bind, atom, 'INTERFACE',
       'interface to listen at (default localhost)').
option(network, seed, integer, 'N',
       'seed of all random choices').
option(network, log, atom, 'FILE',
       'write the events of all hosts to FILE').
option(network, events, atom, 'A,B',
       'with --log: also hops, messages, messages(content), facts').
option(network, machines, atom, 'A,B',
       'ssh targets to start the processes on').
option(network, start, term, 'HOW',
       'where processes run: local, ssh([''user@machine'']), slurm([nodes(4)])').
option(network, dynamic, term, 'MODEL',
       'model of the changes of links').
option(network, hop_time, term, 'uniform(A,B)',
       'delay added to every hop, in host seconds').
option(network, clock, number, 'RATE',
       'host seconds in a real second').
option(page, host, atom, 'ADDRESS',
       'host whose network is shown (required)').
option(page, port, nonneg, 'PORT',
       'TCP port of the page (default 8080, 0 for any)').
option(page, bind, atom, 'INTERFACE',
       'interface of the page (default localhost)').
option(page, read_only, boolean, boolean,
       'accept no orders from the page').
option(page, export, atom, 'FILE',
       'write a page that replays LOG to FILE, and serve none').
option(journal, fleet, atom, 'FLEET',
       'DIR is the name of a journal in the engine of this fleet').
option(journal, agents, boolean, '',
       'print a line for each agent').
option(journal, check, boolean, '',
       'check that all of it can be read').
option(journal, extract, atom, 'AGENT',
       'with --to: write a restore point of AGENT').
option(journal, to, atom, 'FILE',
       'the file to write').
option(create, host, atom, 'ADDRESS',
       'host of the new agent (required)').
option(create, name, atom, 'NAME',
       'name at the beginning of its id').
option(create, tokens, atom, 'A,B',
       'tokens of the agent').
option(create, payload, atom, 'FILE',
       'payload of the agent (may be repeated)').
option(create, fact, term, 'FACT',
       'fact of its state (may be repeated)').
option(create, lifetime, nonneg, 'HOPS',
       'maximum number of its hops').
option(create, static, boolean, '',
       'the agent cannot move').
option(create, join, number, 'SECONDS',
       'wait for its end, and print its outcome').
option(tree, host, atom, 'ADDRESS', 'host to ask (required)').
option(agents, host, atom, 'ADDRESS', 'host to ask (required)').
option(hosts, host, atom, 'ADDRESS', 'host to ask (required)').
option(send, host, atom, 'ADDRESS',
       'host that finds the agent (default its home)').
option(Command, host, atom, 'ADDRESS',
       'AGENT is the name of an agent in the network of this host') :-
    memberchk(Command, [move, dispose, join]).
option(move, timeout, number, 'SECONDS',
       'seconds to wait for its arrival (default 10)').
option(join, timeout, number, 'SECONDS',
       'seconds to wait (default no limit)').
option(stop, timeout, number, 'SECONDS',
       'seconds to wait for its end (default 20)').
option(log, host, atom, 'ADDRESS',
       'read FILE on the machine of this host').
option(log, serve, boolean, '',
       'run a log server that writes FILE').
option(picture, from, number, 'TIME',
       'draw events from this time on').
option(picture, to, number, 'TIME',
       'draw events until this time').
option(log, port, nonneg, 'PORT',
       'port of the log server (default any free one)').
option(log, bind, atom, 'INTERFACE',
       'interface of the log server (default localhost)').
