:- module(typhon_arrival,
          [ parcel_admit/3,             % +Parcel, +Peer, -Answer
            parcel_returned/3           % +Parcel0, +Formal, -Parcel
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [append/3]).
:- use_module('../base/reports', [report/4]).
:- use_module('../base/durable',
              [ crash_point/1, durable/5, durable_drop_below/3, durable_key/2,
                durable_on/0, durable_put/4, enqueue_changes/0,
                unit_of_work/1 ]).
:- use_module('../base/on_demand',
              [on_demand_later/1, on_demand_load/2, on_demand_missing/2]).
:- use_module('../wire',
              [ endpoint_afterwards/1, endpoint_later/1, endpoint_reply/2,
                endpoint_reply_later/2 ]).
:- use_module('../host',
              [ address_parts/3, event/4, host/3, host_hop/4, schedule/2,
                schedule_adopt/1, schedule_here/3, time_leave/0 ]).
:- use_module('../program', [answer_at/3]).
:- use_module('../agent',
              [ agent/5, agent_extras_load/1, agent_extras_missing/1,
                agent_here/5, agent_order/2, agent_status/3, gate/4,
                gate_refused/4, image_amended/5, image_enter/4, image_entrant/2,
                image_filled/2, image_label/2, image_life/2, image_module/3,
                image_returned/3,
                life_hops/2, with_agent/2 ]).
:- use_module(hop, [taken_over/4]).
:- use_module(whereabouts, [agent_arrived/4, hop_is_new/3]).
:- use_module(mail, [post_waiting/2]).
:- use_module(transfer, [transfer_let_go/4, transfer_over/2]).

/** <module> Arrival of agents

The receiving half of a hop, see typhon_hop: install the agent completely or not
at all, and answer.  A repeated transfer is recognised by the records of the
agent, which is here, has gone on, or has ended.  A hop from a process that may
request it again after a restart has an id, hop_id(Process, N, Least); N grows,
and Process has no open hop with a number less than Least.  Here the ids of
accepted hops are kept, down to Least.

*Threading*: the reader threads of the endpoint.
*/

:- multifile
    typhon_endpoint:connection/2,
    typhon_endpoint:handed/4,
    typhon_endpoint:lent/1,
    typhon_endpoint:requested/4,
    typhon_endpoint:returned/0,
    typhon_runtime:ending/1.

:- dynamic accepted/2.          % Process, N: of the id of an accepted hop

%   Agents may come from there: a worker loads the compiler before.

typhon_endpoint:connection(_, down).
typhon_endpoint:connection(_, up) :-
    (   on_demand_missing(program, runs)
    ->  ignore(on_demand_later(on_demand_load(program, runs)))
    ;   true
    ).

%   The answer is deferred if there is a journal, until the commit, and if code
%   must be loaded first for extras of the agent.  taken_over/4 accepts no agent
%   with extras.

typhon_endpoint:handed(hop, hop(Name, Image, Program), Peer, Verdict) :-
    (   durable_on
    ->  Verdict = deferred
    ;   catch(taken_over(Name, Image, Program, Peer), error(_, _), fail)
    ->  Verdict = accepted
    ;   extras_missing(Image)
    ->  Verdict = deferred
    ;   image_filled(Image, Whole),
        arrived(Name, Whole, Program, none, Peer, Answer),
        hand_verdict(Answer, Name, Verdict)
    ).

hand_verdict(installed(Id), Name, accepted) :-
    !,
    endpoint_afterwards(go_on(Name, Id)).
hand_verdict(Answer, _, Answer).

typhon_endpoint:requested(hop, Hop, Peer, ReplyTo) :-
    (   arg(2, Hop, Image),
        extras_missing(Image),
        endpoint_later(typhon_arrival:load_and_take(Image, Hop, Peer, ReplyTo))
    ->  true
    ;   take(Hop, Peer, ReplyTo)
    ).

take(hop(Name, Image0, Program), Peer, ReplyTo) :-
    image_filled(Image0, Image),
    arrived(Name, Image, Program, none, Peer, Answer),
    answer(Answer, Name, ReplyTo).
take(hop(Name, Image, Program, Label), Peer, ReplyTo) :-
    (   is_hop_id(Label)
    ->  arrived(Name, Image, Program, Label, Peer, Answer),
        answer(Answer, Name, ReplyTo)
    ;   endpoint_reply(ReplyTo, refused(error(type_error(hop_id, Name))))
    ).

extras_missing(Image) :-
    image_life(Image, Life),
    agent_extras_missing(Life).

:- public load_and_take/4.              % goal of a worker

load_and_take(Image, Hop, Peer, ReplyTo) :-
    extras_loaded(Image, Peer),
    take(Hop, Peer, ReplyTo).

extras_loaded(Image, Peer) :-
    image_life(Image, Life),
    catch(agent_extras_load(Life), error(Formal, Context),
          malformed(Peer, error(Formal, Context))).

arrived(Name, Image, Program, Label, Peer, Answer) :-
    catch(arrive_noted(Name, Image, Program, Label, Peer, Answer),
          error(Formal, Context),
          ( malformed(Peer, error(Formal, Context)),
            gate_refused(Name, from(Peer, Program, none), malformed,
                         error(Formal)),
            Answer = refused(error(Formal))
          )).

malformed(Peer, Error) :-
    report(error, malformed_agents, Peer, typhon(raised(Error))).

arrive_noted(Name, Image, Program, Label, Peer, Answer) :-
    (   durable_on
    ->  unit_of_work(arrive(Name, Image, Program, Label, Peer, Answer)),
        crash_point(before_answer)
    ;   arrive(Name, Image, Program, Label, Peer, Answer)
    ).

%   The agent starts after the answer is queued, so that its messages follow the
%   answer.

answer(installed(Id), Name, ReplyTo) :-
    !,
    endpoint_reply_later(ReplyTo, accepted),
    endpoint_afterwards(go_on(Name, Id)).
answer(Answer, _, ReplyTo) :-
    endpoint_reply(ReplyTo, Answer).

%   go_on(+Name, +Id, +Where): run the agent `here`, in this thread, or schedule
%   it, `later`.

go_on(Name, Id, here) :-
    agent_here(Id, _, _, Hash, _),
    schedule_here(Name, Hash, typhon_scheduler:run(Id)).
go_on(Name, Id, later) :-
    schedule(Name, Id).

%!  parcel_admit(+Parcel, +Peer, -Answer) is det.
%
%   The agent of Parcel, see transfer_parcel/2, arrives, as from the process at
%   the endpoint Peer, which it left; not in a reader thread.  Parcel may be any
%   term.  Answer is `accepted`, also if the agent has come before, or
%   refused(Reason).

parcel_admit(Parcel, Peer, Answer) :-
    subsumes_term(parcel(_, _, _, _, _), Parcel),
    Parcel = parcel(_, To, Image, _, Program),
    atom(To),
    address_parts(To, Name, _),
    nonvar(Image),
    image_life(Image, _),
    extras_loaded(Image, Peer),
    arrived(Name, Image, Program, none, Peer, Answer0),
    !,
    admitted(Answer0, Name, Answer).
parcel_admit(_, _, refused(error(type_error(parcel, other)))).

%   No answer informs the home, if the agent left it for here.

admitted(installed(Id), Name, accepted) :-
    !,
    (   agent(Id, _, _, _, Life),
        host(Name, Address, _)
    ->  life_hops(Life, Hops),
        agent_arrived(Id, Address, Hops, none)
    ;   true                            % it was ended meanwhile
    ),
    schedule(Name, Id).
admitted(Answer, _, Answer).

%!  parcel_returned(+Parcel0, +Formal, -Parcel) is det.
%
%   Parcel returns the agent of Parcel0 to the host that it left, by a further
%   hop; error(Formal, _) is raised there at its move.

parcel_returned(parcel(From, To, Image0, Hole-Goals, Program), Formal,
                parcel(To, From, Image, Hole-Goals, Program)) :-
    answer_at(move(To), throw(error(Formal, _)), Hole),
    image_returned(Image0, Goals, Image).

typhon_endpoint:lent(Thread) :-
    schedule_adopt(Thread).

typhon_endpoint:returned :-
    time_leave.

arrive(Name, Image, Papers, HopId, Peer, Answer) :-
    papers_program(Papers, Program),
    image_label(Image, Label),
    (   has_come(HopId, Label)
    ->  Answer = accepted
    ;   image_entrant(Image, Entrant),
        gate(Name, from(Peer, Program, papers(Papers))-Entrant,
             install(Name, Label, Image, HopId-Peer, In), Verdict),
        answer_to(Verdict, In, Name, Label, Peer, Answer)
    ).

%   Program may come wrapped with papers, which prove that the peer may bring
%   the agent.

papers_program(Papers, Program) :-
    (   subsumes_term(papers(_, _), Papers)
    ->  Papers = papers(_, Program)
    ;   Program = Papers
    ).

answer_to(ok, in(Address, Gone), Name, Label, Peer, installed(Id)) :-
    !,
    Label = label(Id, _, _, _),
    call(Gone),
    report_arrival(Name, Address, Label, Peer).
answer_to(Verdict, _, _, _, _, Verdict).

has_come(HopId, _) :-
    HopId \== none,
    HopId = hop_id(Process, N, _),
    accepted(Process, N),
    !.
has_come(_, label(Id, Hops, _, _)) :-
    repeated(Id, Hops).

repeated(Id, Hops) :-
    (   agent(Id, _, _, _, Life)
    ->  life_hops(Life, Hops0),
        Hops0 >= Hops
    ;   \+ hop_is_new(Id, Hops, _)
    ).

%   install(+Name, +Label, +Image, +From, -In, -Verdict): all or nothing; In is
%   in(Address, Gone).  Since the gate tested, the host may have been stopped or
%   the program discarded.  If an agent of this id is here already, one of the
%   two was presumed dead: the one that is here stays.

install(Name, Label, Image0, HopId-Peer, In, Verdict) :-
    (   host(Name, Address, Place)
    ->  Label = label(Id, Hops, _, _),
        image_amended(arrives, Name, from(Peer, Address), Image0, Image),
        In = in(Address, Gone),
        with_agent(Id, install(Id, Hops, Image, HopId, Name, Place, Gone,
                               Verdict))
    ;   Verdict = refused(unknown_host)
    ).

%   All changes are noted and queued before other threads can find the agent.

install(Id, Hops, Image, HopId, Name, Place, Gone, Verdict) :-
    installed(Id, Hops, Image, HopId, Name, Place, Gone, Verdict),
    ( durable_on -> enqueue_changes ; true ).

installed(Id, Hops, Image, HopId, Name, Place, Gone, Verdict) :-
    (   overtaken(Id, Hops)
    ->  Verdict = accepted
    ;   image_module(Image, Place, Module)
    ->  remove_old_copy(Id, Later, Orders, Gone),
        post_waiting(Id, Last),
        append(Later, Last, More),
        (   HopId == none
        ->  true
        ;   note_accepted(HopId)
        ),
        image_enter(Image, Name, Module, More),
        add_orders(Orders, Id),
        Verdict = ok
    ;   Verdict = need_program
    ).

overtaken(Id, Hops) :-
    (   agent(Id, _, _, _, Life)
    ->  (   life_hops(Life, Hops0),
            Hops0 >= Hops
        ->  true
        ;   agent_status(Id, Status, _),
            Status \= transit(_, _)
        )
    ;   \+ hop_is_new(Id, Hops, _)
    ).

add_orders([], _).
add_orders([Order|Orders], Id) :-
    agent_order(Id, Order),
    add_orders(Orders, Id).

%   A copy of the agent that still waits here for an answer is out of date.

remove_old_copy(Id, Mail, Orders, Gone) :-
    (   transfer_let_go(Id, Mail0, Orders0, Gone0)
    ->  transfer_over(Id, _),
        Mail = Mail0,
        Orders = Orders0,
        Gone = Gone0
    ;   Mail = [],
        Orders = [],
        Gone = true
    ).

report_arrival(Name, Address, label(Id, Hops, Since, From), Peer) :-
    debug(typhon(hop), '~w hop ~D: is on ~w, from ~w',
          [Id, Hops, Address, Peer]),
    agent_arrived(Id, Address, Hops, Peer),
    (   host_hop(Name, in, Since, Seconds)
    ->  came_from(From, Peer, Where),
        event(hops, Name, Id, arrived(Where, Seconds))
    ;   true                            % the host is being stopped
    ).

%   The image names the host that the agent left if the process there has a
%   listener.  Else only that process is known.

came_from(none, Peer, Peer) :-
    !.
came_from(From, _, From).

                /*******************************
                *          IDS OF HOPS         *
                *******************************/

%   is_hop_id(@Label) is semidet: Label may come from a peer.

is_hop_id(Label) :-
    Label == none,
    !.
is_hop_id(Label) :-
    subsumes_term(hop_id(_, _, _), Label),
    Label = hop_id(Process, N, Least),
    integer(Least),
    (   durable_on
    ->  durable_key(Process, N)
    ;   atom(Process),
        integer(N)
    ).

note_accepted(hop_id(Process, N, Least)) :-
    durable_put(done, Process, N, N),
    assertz(accepted(Process, N)),
    (   N mod 64 =:= 0,
        accepted(Process, Old),
        Old < Least
    ->  durable_drop_below(done, Process, Least),
        forget_below(Process, Least)
    ;   true
    ).

%   The oldest facts come first, unless the hops arrived in another order.

forget_below(Process, Least) :-
    (   accepted(Process, Old),
        Old < Least
    ->  retractall(accepted(Process, Old)),
        forget_below(Process, Least)
    ;   true
    ).

%   The number is in the term because the key of the database has 32 bits.

:- durable(done, Process, _, N, accepted(Process, N)).

typhon_runtime:ending(after) :-
    retractall(accepted(_, _)).
