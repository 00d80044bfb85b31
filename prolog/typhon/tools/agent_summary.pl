:- module(typhon_agent_summary,
          [ agent_summary/2             % ?Agent, -Glance
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module('../kernel/program', [code_program/2]).
:- use_module('../kernel/host',
              [address_parts/3, host/3, host_time/2, turn_of/3]).
:- use_module('../kernel/agent',
              [agent/5, agent_status/3, life_hops/2, mail_count/2]).
:- use_module('../kernel/travel', [in_doubt/1]).

/** <module> Summaries of agents for tables

A summary of an agent of this process has no goals and facts, which may be
large.

*Threading*: any thread.  No mutex is held: an agent that leaves meanwhile is
left out.
*/

%!  agent_summary(?Agent, -Glance) is nondet.
%
%   Glance is glance(Host, Program, Doing, Hops, Mail): the address of the host
%   of Agent, the name of its program, its activity as text, the number of its
%   hops and the number of messages that wait for it.

agent_summary(Agent, glance(Address, Program, Doing, Hops, Mail)) :-
    agent(Agent, Host, _, Hash, Life),
    host(Host, Address, _),
    code_program(Hash, program(Program, _, _, _)),
    agent_status(Agent, Status, _),
    once(agent_doing(Status, Agent, Host, Doing)),
    life_hops(Life, Hops),
    mail_count(Agent, Mail).

%   The duration of a turn is shown if it is at least a tenth of a second.

agent_doing(running, Agent, _, Doing) :-
    turn_of(Agent, _, Seconds),
    Seconds >= 0.1,
    format(atom(Doing), 'running, ~1f s', [Seconds]).
agent_doing(Status, _, Host, Doing) :-
    doing(Status, Host, Doing).

doing(ready, _, running).
doing(obeying, _, running).
doing(arriving, _, in_transit).
doing(sleeping(inf), _, sleeping).
doing(sleeping(Until), Host, Doing) :-
    number(Until),
    time_left(Until, Host, Left),
    format(atom(Doing), 'sleeping, ~w', [Left]).
doing(waiting(Pattern, Until), Host, Doing) :-
    short_text(Pattern, Text),
    (   number(Until)
    ->  time_left(Until, Host, Left),
        format(atom(Doing), 'waiting for ~w, ~w', [Text, Left])
    ;   atom_concat('waiting for ', Text, Doing)
    ).
doing(leaving(local(Name), _), _, Doing) :-
    bound_for(in_transit, Name, Doing).
doing(leaving(remote(To, _, _), _), _, Doing) :-
    bound_for(in_transit, To, Doing).
doing(transit(To, Sent), _, Doing) :-
    under_way(transit(To, Sent), To, Doing).
doing(cloning(To, Sent), _, Doing) :-
    under_way(cloning(To, Sent), To, Doing).
doing(faulty(Error), _, Doing) :-
    formal(Error, Formal),
    short_text(Formal, Text),
    atom_concat('faulty: ', Text, Doing).
doing(Status, _, Doing) :-
    functor(Status, Doing, _).

under_way(Status, To, Doing) :-
    (   in_doubt(Status)
    ->  bound_for(in_doubt, To, Doing)
    ;   bound_for(in_transit, To, Doing)
    ).

bound_for(State, To, Doing) :-
    (   address_parts(To, Name, _)
    ->  true
    ;   Name = To
    ),
    format(atom(Doing), '~w to ~w', [State, Name]).

time_left(Until, Host, Text) :-
    host_time(Host, Now),
    Left is max(0.0, Until-Now),
    format(atom(Text), '~1f s left', [Left]).

formal(error(Formal, _), Formal) :-
    !.
formal(Ball, Ball).

%   A longer text would not fit in a table.

short_text(Term, Text) :-
    copy_term(Term, Copy, _),
    term_variables(Copy, Variables),
    maplist(=('$VAR'('_')), Variables),
    format(atom(Whole), '~W',
           [ Copy, [quoted(true), numbervars(true), max_depth(8)] ]),
    (   sub_atom(Whole, 0, 45, After, Begin),
        After > 3
    ->  atom_concat(Begin, '...', Text)
    ;   Text = Whole
    ).
