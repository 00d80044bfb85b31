:- module(typhon_host_report,
          [ host_close_up/2             % +Host, -CloseUp
          ]).
:- autoload(library(listing), [portray_clause/1]).
:- use_module(library(solution_sequences), [limit/2]).
:- use_module('../kernel/base/abridged', [abridged/3]).
:- use_module('../kernel/wire', [endpoint_reply/2]).
:- use_module('../kernel/host',
              [ host/3, host_option/2, host_property/2, host_resolve/2,
                host_unknown/1, process_ask/6, scheduler_call/1,
                tuple_sense/2 ]).

/** <module> All that there is to see of one host

What lies in its tuple space, what its place defines and with what options it
runs, as text.  Long values are shortened.

*Threading*: any thread may ask that may wait.  A worker answers.
*/

:- multifile
    typhon_endpoint:requested/4.

%   So much is still read by a person.

most(tuples, 300).
most(clauses, 300).
longest(2000).

%!  host_close_up(+Host, -CloseUp) is det.
%
%   CloseUp is close_up(Properties, Options, Tuples, Clauses, Services): the
%   properties of Host as of host_property/2, and lists of strings.
%
%   @error existence_error(host, Host), host_unreachable(Host)

host_close_up(Host, CloseUp) :-
    host_resolve(Host, Where),
    close_up(Where, CloseUp).

close_up(local(Name), CloseUp) :-
    seen(Name, CloseUp).
close_up(remote(Address, Name, Endpoint), CloseUp) :-
    process_ask(Endpoint, Address, close_up, host(Name), Answer, 10),
    (   Answer == none
    ->  host_unknown(Address)
    ;   CloseUp = Answer
    ).

typhon_endpoint:requested(close_up, host(Name), _Peer, ReplyTo) :-
    scheduler_call(typhon_host_report:reply(Name, ReplyTo)).

:- public
    reply/2.                            % goal of a worker

reply(Name, ReplyTo) :-
    (   host(Name, _, _)
    ->  seen(Name, Answer)
    ;   Answer = none
    ),
    endpoint_reply(ReplyTo, Answer).

                /*******************************
                *            HERE              *
                *******************************/

seen(Name, close_up(Properties, Options, Tuples, Clauses, Services)) :-
    host(Name, _, Place),
    findall(P, ( host_property(Name, P), P \= place(_) ), Properties),
    findall(Text, ( host_option(Name, Option), text(Option, Text) ), Options),
    first(tuples, Text, tuple_text(Place, Text), Tuples),
    first(clauses, Text, clause_text(Place, Text), Clauses),
    findall(Text, service_text(Place, Text), Services).

:- meta_predicate first(+, ?, 0, -).

first(What, Template, Goal, List) :-
    most(What, Most),
    findall(Template, limit(Most, Goal), List).

text(Term, Text) :-
    longest(Longest),
    abridged(Term, Longest, Text).

tuple_text(Place, Text) :-
    tuple_sense(Place, Fact),
    text(Fact, Text).

clause_text(Place, Text) :-
    own_predicate(Place, Head),
    catch(clause(Place:Head, Body), error(_, _), fail),
    clause_string((Head:-Body), Text).

clause_string(Clause, Text) :-
    with_output_to(string(Whole), portray_clause(Clause)),
    longest(Longest),
    (   sub_string(Whole, 0, Longest, _, Begin)
    ->  string_concat(Begin, "...", Text)
    ;   Text = Whole
    ).

own_predicate(Place, Head) :-
    current_predicate(_, Place:Head),
    \+ predicate_property(Place:Head, imported_from(_)),
    functor(Head, Name, _),
    \+ sub_atom(Name, 0, _, _, $).

%   What it offers of modules: their predicates by name.

service_text(Place, Text) :-
    import_module(Place, Module),
    Module \== typhon_vocabulary,
    format(string(Text), 'all of ~q', [Module]).
service_text(Place, Text) :-
    current_predicate(Name, Place:Head),
    predicate_property(Place:Head, imported_from(Module)),
    Module \== system,
    functor(Head, Name, Arity),
    format(string(Text), '~q', [Module:Name/Arity]).
