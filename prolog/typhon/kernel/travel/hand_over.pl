:- module(typhon_hand_over,
          [ hand_over/5,                % +Id, +Host, +Where, +Hole, +Goals
            taken_over/4                % +Host, +Image, +Program, +Peer
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module('../base/durable_changes', [durable_on/0]).
:- use_module('../program', [code_compiled/2, plain_goals/2]).
:- use_module('../wire',
              [ endpoint_afterwards/1, endpoint_hand/4, endpoint_hand_over/2,
                endpoint_hand_to/2,
                endpoint_handed/2 ]).
:- use_module('../host',
              [ event_subscribed/1, host/3, host_came/2, host_left/2,
                host_plain/2, host_plain_leaves/2, real_time/3,
                schedule_here/3, scheduler_call/1 ]).
:- use_module('../agent',
              [ agent_comes/5, agent_gone/3, agent_handed/4,
                agent_here/5, agent_module/4, agent_on/2, agent_ready/2,
                agent_build/5, agent_state/2, agent_thawed/5,
                agent_under_way/6, life_before/2, life_came/2, life_goes/3,
                mail_all/2, mail_back/2, mail_waits/1, program_sent/3,
                with_agent/2 ]).
:- use_module(mail, [backlog/1, post_on/2]).
:- use_module(whereabouts, [agent_came/4, agent_comes_anew/3, agent_went/5]).

/** <module> Hand-over: the short form of a hop

An agent that leaves a host without parts, see typhon_host_parts, for another
process is handed over.  The source keeps only the sent frame, and settlement of
the frame means that the agent has arrived.  No request is open, no goals are
copied, and no module is kept.

In any other case, and when a predicate reads the agent meanwhile, the agent is
_thawed_: the frame is decoded, and the agent is in transit like one that was
sent by request, see typhon_transfer, which does the rest.

An agent that comes to a host without parts is taken over in one step, and
continues in the thread that has read it, if its turns are short.  In any
unusual case this step fails without changes; then the agent arrives like any
other, see typhon_arrival.

*Threading*: hand_over/5 in a worker; the rest in the threads of the endpoint.
*/

:- multifile
    typhon_agents:thaw/1,
    typhon_endpoint:handed_over/2,
    result/2.                   % Result, Transfer: the agent is in transit;
                                % treat Result as the answer to its request

%!  hand_over(+Id, +Host, +Where, +Hole, +Goals) is semidet.
%
%   Send Id, which moves from Host, to Where, as in host_resolve/2, where it
%   continues with Goals, Hole bound to `true`.  Fails without changes if the
%   agent has to go by request: options are in use, there is no connection, its
%   terms cannot travel, it may not move, or it has an order.

hand_over(Id, Host, remote(Address, Name, Endpoint), Hole, Goals) :-
    host_plain_leaves(Host, Since),
    \+ durable_on,
    \+ event_subscribed(hops),
    agent_here(Id, Host, Module, Hash, Life0),
    !,
    life_goes(Life0, Life, Hops),
    agent_state(Module, State),
    (   mail_waits(Id)
    ->  with_agent(Id, mail_all(Id, Mail))
    ;   Mail = []
    ),
    plain_goals(Goals, Plain),
    (   framed(Endpoint, Name, Hash,
               image(Id, Hash, Life, State, Hole-Plain, Mail, Since), Frame),
        Transfer = hop(Id, dest(Address, Name, Endpoint), Hops),
        sig_atomic(with_agent(Id, leave(Transfer, Since, Frame)))
    ->  debug(typhon(hop), '~w hop ~D: leaves for ~w', [Id, Hops, Address])
    ;   with_agent(Id, mail_returned(Id, Mail)),
        fail
    ).

%   An agent that was ended meanwhile has no mailbox: its mail is posted on, so
%   that the senders get a report.

mail_returned(Id, Mail) :-
    (   agent_here(Id, _, _, _, _)
    ->  mail_back(Id, Mail)
    ;   post_on(Id, Mail)
    ).

%   Errors fail here; they are reported when the agent goes by request.

framed(Endpoint, Name, Hash, Image, Frame) :-
    acyclic_term(Image),
    term_attvars(Image, []),
    program_sent(Endpoint, Hash, Program),
    catch(endpoint_hand(Endpoint, hop, hop(Name, Image, Program), Frame),
          error(_, _), fail).

%   Sends the frame last: the agent may be back before another goal runs here.

leave(Transfer, Since, Frame) :-
    Transfer = hop(Id, Dest, Hops),
    agent_handed(Id, Hops, way(Dest, Since), Frame),
    catch(endpoint_hand_over(Frame, Transfer), error(session_closed, _),
          scheduler_call(typhon_hand_over:settled(unsent, Transfer))).

                /*******************************
                *            RESULTS           *
                *******************************/

:- public settled/2.

typhon_endpoint:handed_over(Transfer, Result) :-
    settled(Result, Transfer).

settled(accepted, hop(Id, Dest, Hops)) :-
    with_agent(Id, moved_on(Id, Dest, Hops, Host, Since)),
    !,
    host_left(Host, Since).
settled(Result, Transfer) :-
    ignore(( Transfer = hop(Id, _, _),
             with_agent(Id, thawed(Id)) )),
    result(Result, Transfer).

%   The destination is noted before the agent is removed, and mail that came
%   meanwhile is sent before any that comes later.

moved_on(Id, dest(Address, _, Endpoint), Hops, Host, Since) :-
    agent_under_way(Id, Hops, Host, _, way(_, Since), Frame),
    endpoint_hand_to(Frame, Process),
    agent_went(Id, Address, Hops, Endpoint, Process),
    agent_gone(Id, Hops, Mail),
    post_on(Id, Mail).

                /*******************************
                *            THAWING           *
                *******************************/

typhon_agents:thaw(Id) :-
    sig_atomic(with_agent(Id, thawed(Id))).

%   thawed(+Id) is semidet: inside with_agent/2.  The state, goals and mail are
%   those of the frame; the hop does not count before the agent has arrived.

thawed(Id) :-
    agent_under_way(Id, Hops, Host, _, way(Dest, Since), Frame),
    !,
    endpoint_handed(Frame, hop(_, Image, _)),
    Image = image(Id, Hash, Life1, State, Hole-Goals0, Mail, _),
    life_before(Life1, Life0),
    host(Host, _, Place),
    agent_build(Id, Place, Hash, State-Goals0, Module-Goals),
    arg(1, Dest, Address),
    real_time(Host, Since, Sent),
    agent_thawed(Id, Module, Life0, transit(Address, Sent),
                 hop(Hole-Goals, Hops, Mail, Since)).

                /*******************************
                *            ARRIVAL           *
                *******************************/

%!  taken_over(+Host, +Image, +Program, +Peer) is semidet.
%
%   The process at Peer hands over an agent to Host; the arguments may be any
%   terms.  The agent is here now, and continues after this call.
%
%   @error those of agent_module/4

taken_over(Host, Image, known, Peer) :-
    atom(Host),
    host_plain(Host, Plain),
    \+ event_subscribed(hops),
    is_plain_image(Image, Id, Hash, Life, Hops, Clauses, Goals, Since),
    code_compiled(Hash, Program),
    arg(1, Plain, Address),
    with_agent(Id, install(Id, Hops, Host-Plain, Hash-Program, Life, Clauses,
                           Since, Home)),
    !,
    debug(typhon(hop), '~w hop ~D: is on ~w, from ~w',
          [Id, Hops, Address, Peer]),
    (   Home == here
    ->  true                            % this process is its home
    ;   agent_came(Id, Address, Hops, Peer)
    ),
    endpoint_afterwards(go_on(Id, Host-Hash, context(Program, Id), Goals)).

%   Image is that of an agent without messages and extras.

is_plain_image(image(Id, Hash, Life, State, Hole-Goals, Mail, Since), Id,
               Hash, Life, Hops, Clauses, Goals, Since) :-
    Mail == [],
    atom(Id),
    sub_atom(Id, _, _, _, @),
    !,
    atom(Hash),
    number(Since),
    is_list(Goals),
    life_came(Life, Hops),
    nonvar(State),
    State = state(Empty, Clauses),
    Empty == [],
    is_list(Clauses),
    Hole = true.

%   Signals are deferred, see reader.pl: none interrupts these steps.

install(Id, Hops, Where, Hash-Program, Life, Clauses, Since, Home) :-
    Where = Host-Plain,
    \+ agent_on(Id, _),
    \+ backlog(Id),
    agent_comes_anew(Id, Hops, Home),
    arg(2, Plain, Place),
    agent_module(Id, Place, Program, Clauses),
    (   host_came(Where, Since)
    ->  agent_comes(Id, Host, Id, Hash, Life)
    ;   '$destroy_module'(Id),
        fail
    ).

go_on(Id, Host-Hash, Context, Goals, here) :-
    schedule_here(Host, Hash,
                  typhon_scheduler:run_on(Id, Host, Context, Goals)).
go_on(Id, _, _, Goals, later) :-
    ignore(with_agent(Id, agent_ready(Id, Goals))).
