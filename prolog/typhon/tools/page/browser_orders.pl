:- module(typhon_page_browser_orders,
          [ order_run/2,                % +Message, -Answer
            orders_allowed/2            % +ReadOnly, -Orders
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error),
              [domain_error/2, existence_error/2, type_error/2]).
:- use_module(library(lists), [append/3, member/2, nth1/3, selectchk/3]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module('../../kernel/host',
              [host/3, host_resolve/2, host_start/2, host_stop/1]).
:- use_module('../../kernel/lifecycle',
              [ agent_clone/2, agent_create/3, agent_dispose/1,
                agent_dispose/2, agent_move/2, agent_resume/1, agent_send/2 ]).
:- use_module('../administration',
              [ agent_load/3, agent_save/2, host_property/2, link/2, link/3,
                remote/2, unlink/2 ]).
:- use_module('../checks', [agent_check/1]).
:- use_module('../../network', [network_start/3, network_stop/1]).
:- use_module(editor,
              [ name_in/3, on_console/1, problem_dicts/2, program_at/2,
                read_text/3, saying/2, term_in/4, text_file/3, text_in/3 ]).
:- use_module(models, [model_set_up/1]).
:- use_module(overlays, [mechanism_operator/2]).
:- use_module(protocol, [name_text/2, text/2]).
:- use_module(runs, [run_control/2]).

/** <module> Orders of browsers, on a page that is not read-only

An order calls predicates that programs can call, too: those of library(typhon),
and of the operators of mechanisms.  Terms are sent as text.

  | do            | with                                                    |
  | ------------- | ------------------------------------------------------- |
  | check         | `text` or `program`                                     |
  | create        | `text` or `program`, `host`, `name`, `options`          |
  | send          | `agent`, `message`                                      |
  | move          | `agent`, `host`                                         |
  | clone         | `agent`                                                 |
  | resume        | `agent`                                                 |
  | dispose       | `agent`, `force` (seconds)                              |
  | save          | `agent`; the answer is text                             |
  | load          | `text`, `host`                                          |
  | link          | `a`, `b`, `cost`                                        |
  | unlink        | `a`, `b`                                                |
  | host_start    | `name`, `options`, `at`: a host of the process          |
  | host_stop     | `host`                                                  |
  | network_start | `topology`, `options`                                   |
  | network_stop  | `network`                                               |
  | mechanism     | `mechanism`, `predicate`, `arguments`: see mechanism_run/4 |
  | go, pause, step |                                                       |
  | speed         | `speed`: of virtual time, see module `runs`             |
  | set_up        | `values`: of the model, see module `models`             |

An answer is _{done, said}: the result, and the printed messages.

*Threading*: any thread that may wait.
*/

%!  order_run(+Message:dict, -Answer:dict) is det.
%
%   Run the order in Message, see above.
%
%   @error domain_error(page_order, What), existence_error(page_field, Key)
%   @error page_failed(What) the order failed
%   @error the errors of the order

order_run(Message, _{done:Done, said:Said}) :-
    name_in(do, Message, What),
    saying(on_console(run_order(What, Message, Done)), Messages),
    !,
    problem_dicts(Messages, Said).
order_run(Message, _) :-
    name_in(do, Message, What),
    (   clause(run_order(What, _, _), _)
    ->  throw(error(page_failed(What), _))
    ;   domain_error(page_order, What)
    ).

%!  orders_allowed(+ReadOnly:boolean, -Orders:list(atom)) is det.
%
%   Orders are those that a browser may give: all, or none.

orders_allowed(true, []).
orders_allowed(false, Orders) :-
    findall(Order, clause(run_order(Order, _, _), _), Orders).

:- '$clausable'(run_order/3).

run_order(check, Message, checked) :-
    program_at(Message, Spec),
    agent_check(Spec).
run_order(create, Message, Text) :-
    program_at(Message, Spec),
    findall(Option, option_in(Message, Option), Options0),
    term_in(options, Message, [], More),
    append(Options0, More, Options),
    agent_create(Spec, Agent, Options),
    name_text(Agent, Text).
run_order(send, Message, "sent") :-
    name_in(agent, Message, Agent),
    term_in(message, Message, _, Term),
    agent_send(Agent, Term).
run_order(move, Message, "ordered") :-
    name_in(agent, Message, Agent),
    name_in(host, Message, Host),
    agent_move(Agent, Host).
run_order(clone, Message, Text) :-
    name_in(agent, Message, Agent),
    agent_clone(Agent, Clone),
    name_text(Clone, Text).
run_order(resume, Message, "resumed") :-
    name_in(agent, Message, Agent),
    agent_resume(Agent).
run_order(dispose, Message, "disposed") :-
    name_in(agent, Message, Agent),
    (   get_dict(force, Message, Seconds),
        number(Seconds)
    ->  agent_dispose(Agent, [force(Seconds)])
    ;   agent_dispose(Agent)
    ).
run_order(save, Message, Text) :-
    name_in(agent, Message, Agent),
    tmp_file(typhon_saved, File),
    call_cleanup(( agent_save(Agent, File),
                   read_file_to_string(File, Text, [encoding(utf8)]) ),
                 discard(File)).
run_order(load, Message, Text) :-
    text_in(text, Message, Saved),
    text_file(Saved, 'saved.pl', File),
    findall(Option, host_in(Message, Option), Options),
    agent_load(File, Agent, Options),
    name_text(Agent, Text).
run_order(link, Message, "linked") :-
    two_hosts(Message, A, B),
    (   term_in(cost, Message, none, Cost),
        Cost \== none
    ->  link(A, B, [cost(Cost)])
    ;   link(A, B)
    ).
run_order(unlink, Message, "unlinked") :-
    two_hosts(Message, A, B),
    unlink(A, B).
run_order(host_start, Message, Text) :-
    name_in(name, Message, Name),
    term_in(options, Message, [], Options),
    (   get_dict(at, Message, At0),
        At0 \== ""
    ->  atom_string(At, At0),
        remote(At, ( call(typhon:host_start(Name, Options)),
                     call(typhon:host_property(Name, address(Address))) ))
    ;   host_start(Name, Options),
        host_property(Name, address(Address))
    ),
    name_text(Address, Text).
run_order(host_stop, Message, "stopped") :-
    name_in(host, Message, Host),
    host_resolve(Host, Where),
    stop_at(Where).
run_order(network_start, Message, Text) :-
    term_in(topology, Message, _, Topology),
    term_in(options, Message, [], Options),
    network_start(Topology, Network, Options),
    name_text(Network, Text).
run_order(network_stop, Message, "stopped") :-
    name_in(network, Message, Network),
    network_stop(Network).
run_order(mechanism, Message, Results) :-
    name_in(mechanism, Message, Mechanism),
    name_in(predicate, Message, Name),
    get_dict(arguments, Message, Arguments),
    mechanism_run(Mechanism, Name, Arguments, Results).

run_order(go, Message, "goes on") :-
    run_control(go, Message).
run_order(pause, Message, "paused") :-
    run_control(pause, Message).
run_order(step, Message, "stepped") :-
    run_control(step, Message).
run_order(speed, Message, "set") :-
    run_control(speed, Message).
run_order(set_up, Message, "set up") :-
    model_set_up(Message).

option_in(Message, Option) :-
    host_in(Message, Option).
option_in(Message, name(Name)) :-
    get_dict(name, Message, Text),
    Text \== "",
    name_in(name, Message, Name).

host_in(Message, host(Host)) :-
    get_dict(host, Message, Text),
    Text \== "",
    name_in(host, Message, Host).

two_hosts(Message, A, B) :-
    name_in(a, Message, A),
    name_in(b, Message, B).

discard(File) :-
    ( exists_file(File) -> delete_file(File) ; true ).

%   A process may end with its last host, before it has answered: so the goal
%   only creates a thread there, which stops the host.

stop_at(local(Name)) :-
    host_stop(Name).
stop_at(remote(Address, Name, _)) :-
    remote(Address, \+ \+ thread_create(typhon:host_stop(Name), _,
                                          [detached(true)])).

:- multifile
    prolog:error_message//1.

prolog:error_message(page_failed(What)) -->
    [ '~w failed'-[What] ].

                /*******************************
                *          MECHANISMS          *
                *******************************/

%   mechanism_run(+Mechanism, +Name, +Arguments:list, -Results) is det.
%
%   Call the predicate Name of the operator of Mechanism.  Each of Arguments is
%   the text of a term, a list of addresses, _{options, settings} with the texts of
%   the options and of settings by name, or an empty text for an output argument;
%   Results are the texts of the output arguments.
%
%   @error existence_error(mechanism, Mechanism), existence_error(procedure, PI)
%   @error page_failed(PI), and the errors of the operator

mechanism_run(Mechanism, Name, Arguments, Results) :-
    mechanism_operator(Mechanism, Module),
    maplist(argument, Arguments, Terms),
    length(Terms, Arity),
    module_property(Module, exports(Exports)),
    (   memberchk(Name/Arity, Exports)
    ->  true
    ;   existence_error(procedure, Name/Arity)
    ),
    findall(N, nth_unbound(N, Terms), Unbound),
    Goal =.. [Name|Terms],
    (   call(Module:Goal)
    ->  findall(Text, ( member(N, Unbound),
                        arg(N, Goal, Term),
                        text(Term, Text) ), Results)
    ;   throw(error(page_failed(Name), _))
    ).

nth_unbound(N, Terms) :-
    nth1(N, Terms, Term),
    var(Term).

argument(Hosts, Terms), is_list(Hosts) =>
    maplist(address, Hosts, Terms).
argument("", _) =>
    true.
argument(Text, Term), string(Text) =>
    read_text(argument, Text, Term).
argument(_{options:Text, settings:Texts}, Options) =>
    argument(Text, Options0),
    dict_pairs(Texts, _, Pairs0),
    findall(Name-Value, ( member(Name-Written, Pairs0),
                          read_text(Name, Written, Value) ), Pairs),
    with_settings(Options0, Pairs, Options).
argument(Other, _) =>
    type_error(text, Other).

%   Settings that are written among the options count first.

with_settings(Options0, Pairs, [settings(All)|Options]) :-
    (   selectchk(settings(Own), Options0, Options)
    ->  append(Own, Pairs, All)
    ;   Options = Options0,
        All = Pairs
    ).

address(Text, Address) :-
    atom_string(Address, Text).
