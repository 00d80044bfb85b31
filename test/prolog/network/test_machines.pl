:- module(test_machines, []).

% Where the processes of a network start: start(How), without other machines.

:- use_module('../../lib/common').
:- use_module('../../lib/fixtures').
:- use_module('../../lib/networks').
:- use_module('../../lib/texts', [message_text/2]).
:- use_module(library(plunit)).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(typhon)).

%   error_of(+How, -Formal, -Text): network_start(.., [start(How)]) raises an
%   error, and leaves nothing behind.

error_of(How, Formal, Text) :-
    error_of(How, [], Formal, Text).

error_of(How, Options, Formal, Text) :-
    no_leaks(capturing(catch(network_start(ring(2), _, [start(How)|Options]),
                             Error, true), _)),
    assertion(nonvar(Error)),
    Error = error(Formal, _),
    message_text(Error, Text).

one_line(Text, Parts) :-
    split_string(Text, "\n", "\n", Lines),
    assertion(Lines = [_]),
    forall(member(Part, Parts),
           ( sub_string(Text, _, _, _, Part) -> true
           ; assertion(missing(Part, Text) == none) )).

%   with_ssh(+Line, :Goal): the program that reaches machines is a script.

:- meta_predicate with_ssh(+, 0).

with_ssh(Line, Goal) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, rsh, Program),
          shell_script(Program, Line),
          with_settings([typhon_children:ssh=Program], Goal) )).

:- begin_tests(start).

test(local_hosts, true(Pids == [Me])) :-
    current_prolog_flag(pid, Me),
    with_network(ring(2), [start(local)], Network,
                 network_property(Network, processes(Pids))).
test(local_processes_do_not_get_the_cookie_by_the_environment, In == none) :-
    with_network(ring(4), [start(local), processes(2)], Network, Hosts,
                 ( network_property(Network, processes([_, _])),
                   Hosts = [_, _, _, Host],
                   create([ (main :- ( getenv('TYPHON_COOKIE', In) -> true
                                     ; In = none ),
                                     result(In)) ], Agent, [host(Host)]),
                   agent_result(Agent, In, 60) )).
test(wrong_how,
     [ forall(member(How, [far, ssh, ssh([]), ssh(_), ssh(far), ssh('a@b', c),
                           slurm, kubernetes, 7, "ssh", ssh([_]),
                           machines([far])])) ]) :-
    error_of(How, Formal, Text),
    assertion(memberchk(Formal, [domain_error(start, _), type_error(machine, _),
                                 type_error(list, _)])),
    one_line(Text, []),
    (   Formal = domain_error(_, _)
    ->  one_line(Text, ["start(local)", "start(ssh(", "start(slurm("])
    ;   true
    ).
test(how_is_not_bound, error(instantiation_error)) :-
    network_start(ring(2), _, [start(_)]).
test(wrong_machine,
     [ forall(member(Machine-Formal,
                     [ '-oProxyCommand=x'-domain_error(machine, _),
                       machine('-V', [])-domain_error(machine, _),
                       ''-domain_error(machine, _),
                       'robot@'-domain_error(machine, _),
                       7-type_error(machine, _),
                       "far"-type_error(machine, _),
                       machine(7, [])-type_error(atom, 7),
                       machine(far, [swipel(x)])-
                       domain_error(machine_option, swipel(x)),
                       machine(far, [more(x)])-type_error(_, _) ])) ]) :-
    error_of(ssh([Machine]), Formal, Text),
    one_line(Text, []),
    assertion(nonvar(Formal)).
test(target_that_is_an_option_of_ssh_is_refused_in_machines,
     error(domain_error(machine, '-oProxyCommand=x'))) :-
    no_leaks(network_start(ring(2), _, [machines(['-oProxyCommand=x'])])).
test(wrong_option_of_slurm,
     [ forall(member(Option-Formal,
                     [ nodes(0)-type_error(positive_integer, 0),
                       nodse(2)-domain_error(slurm_option, nodse(2)),
                       partition(7)-type_error(atom, 7),
                       more('-x')-type_error(_, _) ])) ]) :-
    error_of(slurm([Option]), Formal, Text),
    one_line(Text, []).
test(names_of_options_of_slurm_are_proposed) :-
    error_of(slurm([nodse(2)]), _, Text),
    one_line(Text, ["did you mean node or nodes?"]).
test(machines_are_named_once,
     error(permission_error(set, network_option, start(ssh([far]))))) :-
    network_start(ring(2), _, [start(ssh([far])), machines([far])]).
test(virtual_time_stays_here,
     [ forall(member(How, [ssh([far]), slurm([])])),
       error(permission_error(carry, virtual_time, start(How))) ]) :-
    network_start(ring(2), _, [clock(virtual), start(How)]).

%   What the program that reaches a machine does, how long the start waits, and
%   what the error says.

refused("exit 255", 60,
        "on me@far: ssh cannot log in, try: ssh me@far true").
refused("exit 127", 60, "on me@far: swipl is not found there").
refused("exit 1", 60, "on me@far: Typhon does not start there").
refused("echo \"typhon_node_process_error error(foo_error(1),context(_,_))\"",
        60, "on me@far").
refused("exec sleep 60", 2,
        "on me@far: it does not answer, try: ssh me@far true").

test(error_names_the_machine_and_the_remedy,
     [forall(refused(Line, Seconds, Said))]) :-
    with_settings([typhon_processes:start_seconds=Seconds,
                   typhon_children:stop_seconds=0.5],
                  with_ssh(Line, error_of(ssh(['me@far']), _, Text))),
    one_line(Text, [Said]).
test(missing_ssh_is_named) :-
    with_settings([typhon_children:ssh=no_such_program],
                  error_of(ssh(['me@far']), existence_error(_, _), Text)),
    one_line(Text, ["on me@far: install ssh here"]).
test(missing_slurm_is_named) :-
    getenv('PATH', Path),
    with_tmp_dir(Dir,
        ( forall(member(Program, [env, sh]),
                 ( directory_file_path(Dir, Program, File),
                   absolute_file_name(path(Program), There,
                                      [access(execute)]),
                   link_file(There, File, symbolic) )),
          setup_call_cleanup(setenv('PATH', Dir),
                             error_of(slurm([nodes(2)]), Formal, Text),
                             setenv('PATH', Path)) )),
    assertion(Formal == resource_error(nodes(2))),
    one_line(Text, ["install the commands of Slurm here"]).
test(options_of_ssh_precede_the_target) :-
    with_ssh("[ \"$1 $2 $3\" = '-p 2222 me@127.0.0.1' ] && shift 3 && \c
              exec sh -c \"$*\"",
             with_network(ring(2),
                          [ start(ssh([machine('me@127.0.0.1',
                                               [more(['-p', 2222])])])) ],
                          _, Hosts, length(Hosts, 2))).

:- end_tests(start).
