:- module(test_error_text, []).
:- use_module('../../lib/common').
:- use_module('../../lib/fixtures').
:- use_module('../../lib/peers').
:- use_module('../../../prolog/typhon/kernel/base/error_text').
:- use_module('../../../prolog/typhon/kernel/base/error_lines').
:- use_module('../../../prolog/typhon/kernel/agent', [is_printable/1]).
:- use_module('../../../prolog/typhon/kernel/wire/peer_cache',
              [peer_missed/2]).
:- use_module('../../../prolog/typhon/options/tls', []).
:- use_module(library(plunit)).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(typhon)).

/** <module> Errors of agents and of other processes are only data

A hostile error would set a flag when it is printed.

*Threading*: one test at a time.
*/

harm(flag(typhon_printed, _, 1)).

%   hostile(-Ball): SWI-Prolog calls a goal when it prints this.

hostile(format("~@", [Harm])) :- harm(Harm).
hostile(error(format("~@", [Harm]), _)) :- harm(Harm).
hostile(error(format("~:@", [Harm]), context(a/1, b))) :- harm(Harm).
hostile(unhandled_exception(format("~@", [Harm]))) :- harm(Harm).
hostile(unhandled_exception(error(format("~@", [Harm]), _))) :- harm(Harm).
hostile(initialization_exception(format("~@", [Harm]))) :- harm(Harm).
hostile(error(thread_error(x, exception(format("~@", [Harm]))), _)) :-
    harm(Harm).
hostile(error(initialization_error(format("~@", [Harm]), x, f:1), _)) :-
    harm(Harm).
hostile(error(existence_error(x, y), initialization_exception(Harm))) :-
    harm(Harm).
hostile(debug(Format, [Harm])) :- Format = "~@", harm(Harm).
hostile(goal_failed(user, Harm)) :- harm(Harm).
hostile(halt(1)).
hostile(unwind(halt(1))).
hostile(unwind(abort)).
hostile(typhon(log(a, b, format("~@", [Harm])))) :- harm(Harm).
hostile(error(resource_error(stack), _)).

%   A harmless error raised in another process stays unchanged.

kept(type_error(integer, a)).
kept(existence_error(procedure, foo/1)).
kept(existence_error(host, nowhere)).
kept(move_refused(h, capacity)).
kept(resource_error(seconds)).
kept(timeout_error(read, x)).
kept(syntax_error(operator_expected)).
kept(my_error(1, "two")).
kept(instantiation_error).

                /*******************************
                *           PRINTING           *
                *******************************/

:- dynamic
    printing/0,
    printed/1.                          % Text

:- multifile
    user:message_hook/3,
    user:portray/1.
:- dynamic
    user:message_hook/3,
    user:portray/1.

%   As on the screen.

user:message_hook(_, Kind, Lines) :-
    printing,
    memberchk(Kind, [error, warning, informational]),
    with_output_to(string(Text),
                   print_message_lines(current_output, '', Lines)),
    assertz(test_error_text:printed(Text)).

user:portray(typhon_portrayed(_)) :-
    test_error_text:printing,
    flag(typhon_printed, _, 1),
    write(portrayed).

printing(Goal, Texts) :-
    flag(typhon_printed, _, 0),
    retractall(printed(_)),
    setup_call_cleanup(assertz(printing), once(Goal), retractall(printing)),
    findall(Text, retract(printed(Text)), Texts).

untouched :-
    flag(typhon_printed, 0, 0).

%   The reaction of the top level to an uncaught error.

at_the_top_level(Ball) :-
    print_message(error, Ball),
    print_message(warning, unhandled_exception(Ball)).

%   shown(Formal, Text): of errors of ISO and SWI-Prolog, and why a host refuses
%   an agent.

shown(instantiation_error, "Arguments are not sufficiently instantiated").
shown(uninstantiation_error(x), "Uninstantiated argument expected, found x").
shown(type_error(evaluable, f/1), "Arithmetic: `f/1' is not a function").
shown(type_error(t, Culprit), Text) :-
    member(Culprit-Kind,
           [ 1-"an integer", 1.5-"a float", 1r3-"a rational", "a"-"a string",
             a-"an atom", [a]-"a list", f(x)-"a compound", _{a:1}-"a dict",
             []-"an empty_list" ]),
    format(string(Text), "Type error: `t' expected, found `~p' (~s)",
           [Culprit, Kind]).
shown(domain_error(d, x), "Domain error: `d' expected, found `x'").
shown(existence_error(procedure, p/1), "Unknown procedure: p/1").
shown(existence_error(matching_rule, p(1)), "No rule matches p(1)").
shown(existence_error(file, f), "file `f' does not exist").
shown(existence_error(key, k, d), "key `k' does not exist in d").
shown(permission_error(modify, static_procedure, p/1),
      "No permission to modify static procedure `p/1'").
shown(permission_error(call, built_in_procedure, p/1),
      "No permission to call built-in predicate `p/1'").
shown(permission_error(open, door, d), "No permission to open door `d'").
shown(representation_error(r), "Cannot represent due to `r'").
shown(evaluation_error(undefined),
      "Arithmetic: evaluation error: `undefined'").
shown(resource_error(memory), "Not enough resources: memory").
shown(busy(mutex, m), "mutex `m' is busy").
shown(timeout_error(read, s), "Timeout in read from s").
shown(io_error(read, s), "I/O error in read on stream s").
shown(socket_error(eother, "no"), "Socket error: no").
shown(ssl_error('1', x, f, why), "SSL(1) f: why").
shown(system_error("bad"), "error in system call: bad").
shown(shell(127, ls), "Could not execute `ls' (127)").
shown(format("few"), "Format error: few").
shown(format_argument_type(d, x),
      "Illegal argument to format sequence ~d: x").
shown(duplicate_key(k), "Duplicate key: k").
shown(goal_failed(p(1)), "goal unexpectedly failed: p(1)").
shown(determinism_error(p/1, det, fail, property),
      "p/1 is declared det, and was fail").
shown(syntax_error(What), Text) :-
    member(What-Words,
           [ cannot_start_term-"Illegal start of term",
             operator_clash-"Operator priority clash",
             operator_balance-"Unbalanced operator",
             end_of_clause-"Unexpected end of clause",
             end_of_file-"Unexpected end of file",
             list_rest-"Unexpected comma or bar in rest of list",
             quoted_punctuation-
             "Operand expected, unquoted comma or bar found",
             undefined_char_escape-"Undefined char escape",
             'as it is'-"as it is" ]),
    string_concat("Syntax error: ", Words, Text).
shown(move_refused(h, Why), Text) :-
    member(Why-Words,
           [ capacity-"it is full",
             token-"none of its tokens is wanted there",
             unsigned-"no author that it trusts has signed its code",
             identity-"its owner has not signed its identity",
             unknown_host-
             "there is no host of that name in the process of the agent; for \c
              other processes let it carry the address, as \c
              host_property(h, address(A)) gives it",
             quota(cells)-"the quota of cells would be exceeded",
             other(1)-"other(1)" ]),
    string_concat("h refuses to admit the agent: ", Words, Text).

%   unreached(Formal, Text): why there is no connection to a process.

unreached(late, "it does not answer").
unreached(timeout_error(read, s), "it does not answer").
unreached(socket_error(x, "Connection Refused"), "connection refused").
unreached(permission_error(use, cookie_file, f),
          "the cookie file f may not be used").
unreached(permission_error(authenticate, peer, Why), Text) :-
    member(Why-Text,
           [ cookie-"it has another cookie",
             protocol-"something else answers there",
             version(7)-"it speaks another version of the protocol, 7",
             tls(missing)-"it connects without TLS",
             tls(wanted)-"it requires TLS, and we have no keys",
             tls(unknown)-"it uses TLS, and we have no keys",
             tls(plain)-"it does not use TLS",
             tls('peer did not return a certificate')-
             "it sent no certificate",
             tls('unsupported protocol')-"it does not use TLS 1.3",
             tls('version too low')-"it does not use TLS 1.3",
             tls(expired)-"its certificate has expired",
             tls(revoked)-"its certificate is revoked",
             tls(wrong_use)-"its certificate is not a host certificate",
             tls(self_made)-"its certificate is self-signed",
             tls(foreign)-"its certificate was issued by another authority",
             tls(his(expired))-"it reports that our certificate has expired",
             tls(strange)-"TLS failed: strange" ]).

:- begin_tests(error_text).

test(reasons_why_a_process_is_not_reached,
     [forall(unreached(Formal, Why)), Text == Expected]) :-
    peer_missed('h.test:1', Formal),
    error_text(error(host_unreachable('a@h.test:1'), _), Text),
    string_concat("Host 'a@h.test:1' cannot be reached: ", Why, Expected).

test(texts, [forall(shown(Formal, Expected)), Text == Expected]) :-
    error_text(error(Formal, _), Text).

test(hostile_errors_are_written,
     [forall(hostile(Ball)), true(Text \== "")]) :-
    printing(( error_text(Ball, Text), print_error(error, Ball) ), [_]),
    untouched.
test(forwarded_errors_are_harmless, [forall(hostile(Ball0))]) :-
    harmless_error(Ball0, Ball),
    printing(at_the_top_level(Ball), [_,_]),
    untouched.
test(ordinary_errors_are_unchanged,
     [forall(kept(Formal)), true(Ball =@= error(Formal, _))]) :-
    harmless_error(error(Formal, _), Ball).
test(ordinary_balls_are_unchanged,
     [forall(member(Ball0, [oops, my(1)])), true(Ball == Ball0)]) :-
    harmless_error(Ball0, Ball).
test(textual_context_is_kept,
     Ball == error(type_error(integer, a), context(foo/1, 'a remark'))) :-
    harmless_error(error(type_error(integer, a), context(foo/1, 'a remark')),
                   Ball).
test(other_context_is_removed, Ball =@= error(type_error(integer, a), _)) :-
    harmless_error(error(type_error(integer, a), at(x, y, z)), Ball).
test(text_of_iso_errors,
     Text == "foo/1: Type error: `integer' expected, found `a' (an atom) \c
              (why)") :-
    error_text(error(type_error(integer, a), context(foo/1, why)), Text).
test(text_of_unknown_errors,
     Text == "Unknown error term: format(\"~@\",[halt])") :-
    error_text(error(format("~@", [halt]), _), Text).
test(large_terms_are_not_printed, true(Length < 200)) :-
    dag(60, a, T),
    error_text(error(type_error(x, T), _), Text),
    string_length(Text, Length).
test(printing_hooks_are_not_called,
     Text == "Unhandled exception: typhon_portrayed(x)") :-
    printing(error_text(typhon_portrayed(x), Text), _),
    untouched.

test(control_characters_in_names_are_escaped,
     [ forall(member(Name, ['a\e[31mb', 'a\nb', 'a\u202eb', f('\e[2J')])),
       Shown == true ]) :-
    phrase(prolog:message(typhon(undeliverable(existence_error(agent, x), Name,
                                               Name, hello))), Lines),
    with_output_to(string(Text),
                   print_message_lines(current_output, '', Lines)),
    split_string(Text, "\n", "", [First,Second|_]),
    (   is_printable(First), is_printable(Second)
    ->  Shown = true
    ;   Shown = Text
    ).
test(long_names_are_shortened, true(Length < 500)) :-
    numlist(1, 20 000, Ns),
    atomic_list_concat(Ns, Name),
    phrase(prolog:message(typhon(undeliverable(existence_error(agent, x), Name,
                                               a, hello))), Lines),
    with_output_to(string(Text),
                   print_message_lines(current_output, '', Lines)),
    string_length(Text, Length).

:- end_tests(error_text).

dag(0, T, T) :- !.
dag(N0, T0, T) :-
    N is N0-1,
    dag(N, f(T0,T0), T).

                /*******************************
                *            AGENTS            *
                *******************************/

%   raising(-Body, -Ball): Body makes a user see Ball, or a term with it.

raising(throw(Ball), Ball).
raising((log(Ball), throw(Ball)), Ball).
raising((send(user, Ball), throw(Ball)), Ball).
raising((self(Me), send(Me, Ball)), Ball).
raising((G = foo(Ball), call(G)), Ball).
raising((s(Ball) -> true ; fail), Ball).
raising(atom_length(Ball, _), Ball).

:- begin_tests(errors_of_agents).

test(printing_a_raised_term_calls_nothing,
     [forall(( member(Options, [[], [policy(guarded), cell(none)]]),
               hostile(Ball), \+ Ball = unwind(_) ))]) :-
    with_hosts([g-Options],
               printing(forall(raising(Body, Ball),
                               raise_in_agent(Body)), Texts)),
    Texts = [_|_],
    untouched.
test(printing_hooks_do_not_see_raised_terms) :-
    with_hosts([g],
               printing(( forall(raising(Body, typhon_portrayed(x)),
                                 raise_in_agent(Body)),
                          forall(raising(Body, error(typhon_portrayed(x), _)),
                                 raise_in_agent(Body)) ), Texts)),
    Texts = [_|_],
    untouched.

:- end_tests(errors_of_agents).

raise_in_agent(Body) :-
    create([ (main :- Body), (on_message(_, _) :- fail) ], A, [host(g)]),
    wait_until(rests(A), 10),
    catch(agent_dispose(A), error(existence_error(agent, _), _), true).

rests(A) :-
    \+ ( catch(agent_property(A, state(State)), error(_, _), fail),
         \+ memberchk(State, [faulty(_), resident]) ).

                /*******************************
                *        OTHER PROCESSES       *
                *******************************/

thrown_there(There, Ball0, Ball) :-
    catch(remote(There, throw(Ball0)), Ball, true).

:- begin_tests(errors_of_other_processes).

test(errors_of_another_process_are_harmless_and_unchanged) :-
    no_leaks(with_peers([p-[host([])]],
        ( peer_host(p, There),
          forall(( hostile(Ball0), \+ Ball0 = unwind(_) ),
                 printed_harmlessly(There, Ball0)),
          forall(kept(Formal),
                 ( thrown_there(There, error(Formal, _), error(Formal1, _)),
                   assertion(Formal1 == Formal) )),
          thrown_there(There, oops, Oops),
          assertion(Oops == oops) ))).
test(process_of_a_network_returns_errors_as_data) :-
    no_leaks(setup_call_cleanup(
        network_start(line(2), N, [processes(2)]),
        ( network_property(N, hosts([Host|_])),
          forall(( hostile(Ball), \+ Ball = unwind(_) ), % may be halt/1
                 returned_harmlessly(N, Host, Ball)) ),
        network_stop(N))).

:- end_tests(errors_of_other_processes).

returned_harmlessly(Network, Host, Ball0) :-
    atomic_list_concat([Name, _], @, Host),
    catch(typhon_nodes:node_order(Network, 1, places([Name-throw(Ball0)]), _),
          Ball, true),
    printing(at_the_top_level(Ball), _),
    assertion(untouched),
    remote(Host, flag(typhon_printed, There, There)),
    assertion(There == 0).

printed_harmlessly(There, Ball0) :-
    thrown_there(There, Ball0, Ball),
    printing(at_the_top_level(Ball), _),
    assertion(untouched).
