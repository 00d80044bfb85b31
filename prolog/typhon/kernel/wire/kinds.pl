:- module(typhon_kinds,
          [ arrival_permitted/4,        % +Form, +Kind, +Term, +Peer
            arrival_verdict/5,          % +Form, +Kind, +Term, +Peer, -Verdict
            right/3,                    % ?Right, ?Needs, ?Audit
            arrives/6                   % ?Form, ?Kind, ?Term, ?Right, ?Scope,
                                        % ?Module
          ]).

/** <module> What other processes may send

Each term that another process may send is declared here once: its form and
kind, its arguments with their types, the right that the process needs, on
which hosts, and the module that handles it. The dispatcher refuses all other
terms, and all processes without the right, before it calls a hook or loads
code. The table of doc/wire.md is made from these declarations, and `make
check` compares them with the clauses of the hooks.

Forms are

  | post, request, hand | the frames of request.pl                         |
  | news                | an item of the post `whereabouts`                |
  | order               | what the request `node`, which only the parent   |
  |                     | of this process may send, has it do              |

Rights are those of right/3, and

  | none   | each process that has proved itself                         |
  | asked  | none, but Module accepts only what this process asked for   |
  | gate   | `agents`; the gate of the host decides, see typhon_gate     |
  | parent | the term holds the secret that the parent of this process   |
  |        | has given it                                                |

Scopes are the hosts on which the right is needed:

  | host(Name)  | that host                                              |
  | agent(Id)   | the host on which the agent is, or else was born; if   |
  |             | neither is in this process, all hosts of this process  |
  | all         | all hosts of this process                              |
  | some        | one host of this process, if there are hosts; Module   |
  |             | answers for the hosts on which the process has it      |

Types of arguments are

  | name       | an atom of at most 65,536 characters                    |
  | term       | any term; bounded, like all, by the size of frames      |
  | list(Type) | a list of at most 1,000,000                             |
  | Constant   | the same atom                                           |
  | Compound   | a term with these types as arguments                    |

and count, number, positive: numbers.

*Threading*: any thread; no state.
*/

:- use_module(library(apply), [maplist/3, maplist/4]).
:- use_module(library(lists), [append/2]).

:- multifile
    accepts/5,                          % Form, Kind, Term, Right, Scope
    peer_permitted/4.                   % Right, Scope, Term, Peer

:- discontiguous
    accepts/5,
    arrives/6.

%!  arrival_permitted(+Form, +Kind, +Term, +Peer) is semidet.
%!  arrival_verdict(+Form, +Kind, +Term, +Peer, -Verdict) is det.
%
%   The process at the address Peer may send Term.  Verdict is `ok`,
%   refused(Right), or `undeclared`.  A refusal is a security event; so is, for
%   some rights, the use of the right.

arrival_permitted(Form, Kind, Term, Peer) :-
    arrival_verdict(Form, Kind, Term, Peer, ok).

arrival_verdict(Form, Kind, Term, Peer, Verdict) :-
    (   atom(Kind),
        nonvar(Term),
        accepts(Form, Kind, Term, Right, Scope)
    ->  (   ( unconditional(Right)
            ; peer_permitted(Right, Scope, Term, Peer) )
        ->  Verdict = ok
        ;   Verdict = refused(Right)
        )
    ;   ignore(peer_permitted(undeclared(Kind), all, Term, Peer)),
        Verdict = undeclared
    ).

unconditional(gate).
unconditional(none).
unconditional(asked).

                /*******************************
                *             TYPES            *
                *******************************/

%   is_a(+Type, ?Term) is semidet.

is_a(name, Term) :-
    atom(Term),
    atom_length(Term, Length),
    Length =< 65 536.
is_a(term, _).
is_a(count, Term) :-
    integer(Term),
    Term >= 0.
is_a(positive, Term) :-
    integer(Term),
    Term > 0.
is_a(number, Term) :-
    number(Term).
is_a(list(Type), Term) :-
    is_list(Term),
    length(Term, Length),
    Length =< 1 000 000,
    all_are(Term, Type).

is_a(Pattern, Term) :-
    compound(Pattern),
    Pattern \= list(_),
    compound(Term),
    compound_name_arguments(Pattern, Name, Types),
    compound_name_arguments(Term, Name, Args),
    maplist(is_a, Types, Args).

all_are(_, term) :-
    !.
all_are([], _).
all_are([Term|Terms], Type) :-
    is_a(Type, Term),
    all_are(Terms, Type).

type(name).
type(count).
type(positive).
type(number).
type(list(_)).

%   tests(+Pattern, -Term, -Tests): Term is a general term for Pattern, which is
%   of the types of Pattern if Tests, a list of goals, succeed.

tests(Var:Type, Var, Tests) :-
    !,
    tests(Type, Var, Tests).
tests(term, _, []) :-
    !.
tests(Type, Term, [is_a(Type, Term)]) :-
    type(Type),
    !.
tests(Constant, Term, [Term == Constant]) :-
    atomic(Constant),
    !.
tests(Pattern, Term, [compound(Term)|Tests]) :-
    compound_name_arguments(Pattern, Name, Types),
    maplist(tests, Types, Args, Tests0),
    compound_name_arguments(General, Name, Args),
    append([[Term = General]|Tests0], Tests).

%   Each declaration, arrives/6 with a pattern of types, also makes a clause
%   of accepts/5, which tests a term.

%   Questions to an agent, and orders to a child, are declared in short.

term_expansion(asked(Question, Right, Module), Clauses) :-
    term_expansion(arrives(request, agent, question(Id:name, Question), Right,
                           agent(Id), Module),
                   Clauses).
term_expansion(ordered(Order), Clauses) :-
    term_expansion(arrives(order, node, Order, none, none, node_process),
                   Clauses).
term_expansion(arrives(Form, Kind, Pattern, Right, Scope, Module),
               [ arrives(Form, Kind, Pattern, Right, Scope, Module),
                 (accepts(Form, Kind, Term, Right, Scope) :- Body) ]) :-
    tests(Pattern, Term0, Tests0),
    in_head(Tests0, Term0, Term, Tests),
    conjunction(Tests, Body).

%   A compound pattern is unified in the head, which is indexed.

in_head([compound(Term0), Term0 = Term|Tests], Term0, Term, Tests) :-
    !.
in_head([Term == Constant], Term, Constant, []) :-
    !.
in_head(Tests, Term, Term, Tests).

conjunction([], true).
conjunction([Test], Test) :-
    !.
conjunction([Test|Tests], (Test, Body)) :-
    conjunction(Tests, Body).

                /*******************************
                *         DECLARATIONS         *
                *******************************/

%!  right(?Right, ?Needs, ?Audit) is nondet.
%
%   Needs is `secret` if only peers with the secret of this process have Right,
%   where no part of a host decides; else `any`.  Audit is `none`, or each use is
%   a security event of that name.

right(agents, any, none).       % create and send agents, report where they are
right(messages, any, none).     % send messages to agents here, and pheromones
right(orders, any, order).      % end, move and change agents, link the host
right(remote, secret, remote).  % run goals here
right(watch, any, none).        % read agents, events, properties of the host
right(log, secret, none).       % write into logs of this process

%!  arrives(?Form, ?Kind, ?Term, ?Right, ?Scope, ?Module) is nondet.
%
%   The pattern Term of types is declared, and Module handles it.

%   Agents: arrival, creation, questions and orders

arrives(hand, hop, hop(_:term, _:term, _:term), gate, none, arrival).
arrives(request, hop, hop(_:term, _:term, _:term), gate, none, arrival).
arrives(request, hop, hop(_:term, _:term, _:term, _:term), gate, none,
        arrival).
arrives(request, agent, create(_:term, _:term, _:term, _:term), gate, none,
        creation).
asked(properties, watch, properties).
asked(mailbox, watch, properties).
asked(program, watch, properties).
asked(results(_:name), watch, join).
asked(trail, watch, trail_verified).
asked(step, orders, stepping).
asked(dispose, orders, disposal).
asked(force, orders, disposal).
asked(order(move(_:name)), orders, orders).
asked(order(arrive(_:name)), orders, orders).
asked(order(dispose), orders, orders).
asked(order(end), orders, orders).
asked(order(resume), orders, orders).
asked(order(clone), orders, orders).
asked(order(detach(_:name)), orders, orders).
asked(order(attach(_:term)), orders, orders).
asked(order(attach(_:term, _:term)), orders, authors).
asked(order(change(_:term)), orders, change).
asked(order(image), orders, restore).
asked(order(watched(_:term)), orders, tracing).

%   Messages

arrives(post, message, message(Id:name, _:list(mail(name, term, term)),
                               _:count),
        messages, agent(Id), mail).
arrives(post, message,
        shown(_:term, message(Id:name, _:list(mail(name, term, term)),
                              _:count)),
        messages, agent(Id), mail).
arrives(post, message, lost(_:term, _:term, _:list(mail(name, term, term))),
        messages, all, mail).
arrives(post, message, abroad(_:term, _:name, _:term), messages, all,
        external_recipients).
arrives(post, message, shown(_:term, abroad(_:term, _:name, _:term)),
        messages, all, external_recipients).

%   Where agents are, and how they ended

arrives(post, whereabouts, _:list(term), none, none, whereabouts).
arrives(post, whereabouts, shown(_:term, _:list(term)), none, none,
        whereabouts).
arrives(news, whereabouts, located(Id:name, _:name, _:count), agents,
        agent(Id), whereabouts).
arrives(news, whereabouts, ended(Id:name, _:term, _:count), agents, agent(Id),
        whereabouts).
arrives(news, whereabouts, ended(Id:name, _:term, _:count, _:list(term)),
        agents, agent(Id), whereabouts).
arrives(news, whereabouts,
        faulty(Id:name, _:term, _:number, _:name, _:count),
        agents, agent(Id), whereabouts).
arrives(news, whereabouts, resumed(Id:name, _:number, _:count), agents,
        agent(Id), whereabouts).
arrives(request, whereabouts, reached(Id:name, _:count), agents, agent(Id),
        transfer).
arrives(request, join, join(Id:name, _:term), watch, agent(Id), whereabouts).
arrives(request, results, left(Id:name, _:name), watch, agent(Id), outcomes).
arrives(request, results, clones(Id:name), watch, agent(Id), outcomes).

%   Hosts

arrives(request, remote, remote(Name:name, _:term), remote, host(Name),
        remote).
arrives(request, hosting, hosts, watch, some, host_questions).
arrives(request, hosting, host_properties(Name:name), watch, host(Name),
        host_questions).
arrives(request, hosting, link(Name:name, _:name), orders, host(Name),
        host_questions).
arrives(request, hosting, link(Name:name, _:name, _:number), orders,
        host(Name), host_questions).
arrives(request, hosting, unlink(Name:name, _:name), orders, host(Name),
        host_questions).
arrives(request, survey, look(_:count), watch, all, inventory).
arrives(request, close_up, host(Name:name), watch, host(Name), inventory).
arrives(request, directory, look(_:list(name), _:term), watch, all, offers).
arrives(post, pheromone,
        pheromone(Name:name,
                  smelt(_:name, signal(_:term, _:name, _:number, _:positive,
                                       _:number, _:number, _:positive))),
        messages, host(Name), pheromone).
arrives(post, pheromone, pheromone(Name:name, withdrawn(_:name, _:term)),
        messages, host(Name), pheromone).
arrives(request, certificate, of_yours, none, none, seals).

%   Events: watches, traces, logs

arrives(request, watch, watch(_:term, all), watch, some, watch_senders).
arrives(request, watch, watch(_:term, _:list(name)), watch, some,
        watch_senders).
arrives(request, watch, unwatch(_:term), none, none, watch_senders).
arrives(request, everywhere, overview, watch, all, watched_hosts).
arrives(request, everywhere, numbers, watch, all, watched_hosts).
arrives(request, watched, events(_:term, _:list(term)), asked, none,
        watch_receiver).
arrives(request, watched, alive(_:term), none, none, watch_receiver).
arrives(request, trace, traced(_:name, _:name, _:term), asked, none, tracing).
arrives(post, log, event(_:name, _:name, _:term, _:term), log, all, log).
arrives(request, log, arrived, none, none, log).

%   Monitors and supervisors

arrives(request, monitor, alive, none, none, failed_processes).
arrives(request, monitor, by(Id:name, begin(_:name, false)), agents,
        agent(Id), monitors).
arrives(request, monitor, by(Id:name, begin(_:name, self)), agents,
        agent(Id), monitors).
arrives(request, monitor, by(_:name, begin(Id:name, _:name)), orders,
        agent(Id), monitors).
arrives(request, monitor, by(Id:name, end(_:name)), agents, agent(Id),
        monitors).
arrives(request, monitor, monitor_add(ends(Id:name), _:name), orders,
        agent(Id), monitors).
arrives(request, monitor, monitor_remove(ends(Id:name), _:name), orders,
        agent(Id), monitors).
arrives(request, monitor, follows(Id:name, _:name), watch, agent(Id),
        monitors).
arrives(request, monitor, relations(_:term), watch, all, relations).
arrives(request, monitor, watch(Id:name), watch, agent(Id), monitored_agents).
arrives(request, monitor, have(_:list(name)), watch, all, monitored_agents).
arrives(request, monitor, end(_:list(name), _:list(name)), orders, all,
        monitored_agents).

%   Durable posts: Term is a post of Kind, and has to be permitted itself

arrives(post, channel,
        channel(_:name, _:name, _:term, _:count, _:name, _:term), none, none,
        channel).
arrives(post, channel, again(_:name), asked, none, channel).
arrives(post, channel, had(_:name, _:count), asked, none, channel).

%   Orders to a child process of a network

arrives(request, node, order(_:name, _:term), parent, none, node_process).
ordered(alive).
ordered(hosts(_:list(name-list(term)))).
ordered(again(_:list(name-list(term)))).
ordered(go_on).
ordered(stop(_:list(name))).
ordered(stop).
ordered(flush(_:number, _:list(name))).
ordered(link(_:list(half(name, name, term)))).
ordered(unlink(_:list(half(name, name, term)))).
ordered(places(_:list(name-term))).
ordered(expect(_:list(name))).
ordered(expect_no_more(_:list(name))).
ordered(neighbours(_:list(name))).
ordered(hold(_:number)).
ordered(let_go).
ordered(rest(_:number, _:list(name))).
ordered(kept(_:list(name))).
ordered(fill(_:name, _:list(term))).
ordered(goes_on(_:name, _:term, _:list(term))).
ordered(agents).
ordered(ended(_:name)).
