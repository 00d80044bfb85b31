:- module(typhon_hop,
          [ hop/5,                      % +Id, +Where, +Hole, +Goals, +Since
            hop_clone/6,                % +Id, +Where, +CloneId, +Who, +Hole,
                                        % +Goals
            hop_state/2,                % +Status, -State
            hop_out_of_touch/1,         % +Status
            hop_given_up/2,             % +Id, +Goals
            hop_let_go/4                % +Id, -Mail, -Orders, -Gone
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../program', [code_program/2]).
:- use_module('../wire',
              [ endpoint_address/1, endpoint_gone/1, endpoint_peer/2,
                endpoint_request/4, mobile_term/1 ]).
:- use_module('../host',
              [ address_parts/3, alarm_set/3, host/3, host_hop/3,
                host_leave/1, host_time/2, scheduler_call/1 ]).
:- use_module('../agent',
              [ agent/5, agent_all_orders/2, agent_home/2, agent_put/3,
                agent_ready/2, agent_remove/1, agent_state/2, agent_status/3,
                mail_all/2, mail_back/2, with_agent/2 ]).
:- use_module(post, [post_on/2]).
:- use_module(whereabouts,
              [ agent_born/2, agent_ended/3, agent_left/4, agent_reached/3,
                agent_reached_at/4 ]).

/** <module> A hop is a transaction

The source freezes the agent and sends its image: state, payloads, goals,
mail.  The receiver installs it and answers, see typhon_arrival, and only
then does the source let its copy go.  The id of a transfer is the agent
with its number of hops.  An agent that comes back before the answer proves
that it had arrived.

  | answer       | the source                                       |
  | ------------ | ------------------------------------------------ |
  | accepted     | forgets the agent; mail that came later follows  |
  | refused(Why) | raises move_refused(Host, Why) at the move       |
  | need_program | sends again, with the program                    |
  | unreachable  | raises host_unreachable(Host) at the move        |
  | lost         | asks whether it got away, see settle/1           |

A destination is dest(Address, Name, Endpoint).  What an answer is for is
hop(Id, Dest, Hops) or clone(Id, Dest, CloneId).

*Threading*: hop/5 in a worker; answers in the reader threads of the
endpoint, which never wait.
*/

:- setting(doubt_seconds, number, 3,
           "An agent under way for longer is shown as in doubt").
:- setting(settle_seconds, number, 1,
           "Seconds until those who did not answer are asked again").

:- multifile
    forward_order/2,            % Id, Order: the agent has left
    typhon_endpoint:connection/2,
    typhon_scheduler:fire/2.

:- dynamic
    has_program/2,              % Endpoint, Hash: was sent there
    given_up/2.                 % Id, Hops: disposed of while in doubt

%!  hop(+Id, +Where, +Hole, +Goals, +Since) is det.
%
%   Send Id to Where, as of host_resolve/2, where it goes on with Goals,
%   Hole bound to `true`.
%
%   @arg Since is the host time at which it set out
%   @error type_error(mobile_term, Culprit)

hop(Id, Where, Hole, Goals, Since) :-
    agent(Id, _, Module, Hash, Life0),
    one_hop_more(Life0, Life, Hops),
    agent_state(Module, State),
    copy_term(Hole-Goals, Hole1-Going),
    ignore(Hole1 = true),
    mobile_term(State-Going),
    destination(Where, Dest, Address),
    sig_atomic(
        ( with_agent(Id, freeze(Id, Address, hop(Hole-Goals, Hops, Mail, Since),
                                Mail))
        ->  send(hop(Id, Dest, Hops),
                 image(Id, Hash, Life, State, Going, Mail, Since))
        ;   true                        % it was ended meanwhile
        )).

%   An interrupt comes before or after both, or an agent would wait for the
%   answer to what was never sent.

freeze(Id, Address, Hop, Mail) :-
    agent_status(Id, Status, _),
    memberchk(Status, [running, obeying]),
    get_time(Sent),
    mail_all(Id, Mail),
    agent_put(Id, transit(Address, Sent), Hop).

one_hop_more(life(Parent, Hops0, Lifetime, Tokens, Payloads, Static),
             life(Parent, Hops, Lifetime, Tokens, Payloads, Static), Hops) :-
    Hops is Hops0+1.

%!  hop_clone(+Id, +Where, +CloneId, +Who, +Hole, +Goals) is det.
%
%   Send a clone of Id to Where; Id waits for the answer, Goals its goals.

hop_clone(Id, Where, CloneId, Who, Hole, Goals) :-
    agent(Id, Host, Module, Hash, Life0),
    clone_life(Id, Life0, Life),
    agent_state(Module, State),
    copy_term(Hole-Goals-Who, (Who1=clone(Id))-Going-Who1),
    mobile_term(State-Going),
    host_time(Host, Since),
    destination(Where, Dest, Address),
    get_time(Sent),
    host(Host, Here, _),
    agent_born(CloneId, Here),
    sig_atomic(
        ( with_agent(Id, agent_put(Id, cloning(Address, Sent),
                                   clone(Hole-Goals-Who, CloneId, Since))),
          send(clone(Id, Dest, CloneId),
               image(CloneId, Hash, Life, State, Going, [], Since)) )).

clone_life(Id, life(_, _, Lifetime, Tokens, Payloads, Static),
           life(Id, 1, Lifetime, Tokens, Payloads, Static)).

%   A host of this process may be stopped while an agent is on its way to
%   it: that changes nothing of its address.

destination(local(Name), dest(Address, Name, Endpoint), Address) :-
    endpoint_address(Endpoint),
    address_parts(Address, Name, Endpoint).
destination(remote(Address, Name, Endpoint), dest(Address, Name, Endpoint),
            Address).

%   image(+For, -Image): once more, from the frozen record.  Fails if it
%   was given up.

image(hop(Id, _, Hops), image(Id, Hash, Life, State, Going, Mail, Since)) :-
    agent(Id, _, Module, Hash, Life0),
    agent_status(Id, transit(_, _), hop(Hole-Going, Hops, Mail, Since)),
    ignore(Hole = true),
    one_hop_more(Life0, Life, Hops),
    agent_state(Module, State).
image(clone(Id, _, CloneId),
      image(CloneId, Hash, Life, State, Going, [], Since)) :-
    agent(Id, _, Module, Hash, Life0),
    agent_status(Id, cloning(_, _),
                 clone(Hole-Going-Who, CloneId, Since)),
    Hole = (Who=clone(Id)),
    clone_life(Id, Life0, Life),
    agent_state(Module, State).

%   send(+For, +Image): what cannot be sent, such as too long a frame,
%   stays.

send(For, Image) :-
    arg(2, For, dest(_, Name, Endpoint)),
    arg(2, Image, Hash),
    catch(( program(Endpoint, Hash, Program),
            endpoint_request(Endpoint, hop, hop(Name, Image, Program),
                             typhon_hop:answered(For))
          ),
          error(Formal, _),
          stays(For, Formal)).

%   The program is sent to those who lack it as far as we know.

program(Endpoint, Hash, known) :-
    has_program(Endpoint, Hash),
    !.
program(Endpoint, Hash, Program) :-
    code_program(Hash, Program),
    bound_programs,
    assertz(has_program(Endpoint, Hash)).

%   What is forgotten is sent once more.

most_programs(10000).

bound_programs :-
    predicate_property(has_program(_, _), number_of_clauses(Count)),
    most_programs(Most),
    Count > Most,
    !,
    retractall(has_program(_, _)).
bound_programs.

typhon_endpoint:connection(Endpoint, down) :-
    retractall(has_program(Endpoint, _)).

                /*******************************
                *            ANSWERS           *
                *******************************/

answered(For, answer(Answer)) :-
    !,
    taken(Answer, For).
answered(For, unreachable) :-
    unreachable(For).
answered(For, lost) :-
    settle(For).

taken(accepted, For) :-
    arrived(For).
taken(refused(Reason), For) :-
    arg(2, For, dest(Address, _, _)),
    stays(For, move_refused(Address, Reason)).
taken(need_program, For) :-
    (   image(For, Image)
    ->  arg(2, For, dest(_, _, Endpoint)),
        arg(2, Image, Hash),
        retractall(has_program(Endpoint, Hash)),
        send(For, Image)
    ;   stays(For, given_up)
    ).

unreachable(For) :-
    arg(2, For, dest(Address, _, _)),
    stays(For, host_unreachable(Address)).

%   settle(+For): the process that was asked is gone.  If the home knows of
%   this hop or a later one the agent got away in time.  If it does not, the
%   news may be under way, or the home was started again, or died together
%   with that process: everybody we know is asked.  If nobody has seen the
%   agent it has not survived there, and goes on here.

settle(For) :-
    traveller(For, Id, Hops),
    agent_reached(Id, Hops, typhon_hop:home_said(For)).

traveller(hop(Id, _, Hops), Id, Hops).
traveller(clone(_, _, CloneId), CloneId, 1).

home_said(For, answer(true)) :-
    !,
    arrived(For).
home_said(For, answer(Reached)) :-
    !,
    scheduler_call(typhon_hop:survey(For, Reached)).
home_said(For, _) :-
    traveller(For, Id, _),
    agent_home(Id, Home),
    address_parts(Home, _, Endpoint),
    (   endpoint_gone(Endpoint)
    ->  scheduler_call(typhon_hop:survey(For, unknown))
    ;   settle_later(For)
    ).

settle_later(For) :-
    setting(settle_seconds, Seconds),
    get_time(Now),
    Stamp is Now+Seconds,
    arg(1, For, Id),
    alarm_set(Stamp, Id, settle(For)).

typhon_scheduler:fire(_, settle(For)) :-
    !,
    (   image(For, _)
    ->  settle(For)
    ;   stays(For, given_up)
    ).

%   survey(+For, +HomeSaid): in a worker.  Where the home has lived on and
%   knows nothing, nobody waits for those who do not answer; else they might
%   be the ones who have the agent.

survey(For, HomeSaid) :-
    traveller(For, Id, Hops),
    findall(Said,
            ( endpoint_peer(Peer, process(_)),
              says(Peer, Id, Hops, Said)
            ),
            All),
    (   memberchk(true, All)
    ->  arrived(For)
    ;   HomeSaid == unknown,
        memberchk(nothing, All)
    ->  settle_later(For)
    ;   unreachable(For)
    ).

says(Peer, Id, Hops, Said) :-
    catch(agent_reached_at(Id, Hops, Peer, Said), error(_, _),
          no_answer(Peer, Said)).

no_answer(Peer, Said) :-
    (   endpoint_gone(Peer)
    ->  Said = false
    ;   Said = nothing
    ).

                /*******************************
                *           ARRIVED            *
                *******************************/

arrived(hop(Id, dest(Address, _, Endpoint), Hops)) :-
    (   with_agent(Id, moved_on(Id, Hops, Address, Endpoint, Orders, Gone))
    ->  call(Gone),
        forall(member(Order, Orders), follow(Id, Order))
    ;   retract(given_up(Id, Hops))
    ->  agent_left(Id, Address, Hops, Endpoint),
        follow(Id, dispose)
    ;   true                            % it came back before the answer
    ).
arrived(clone(Id, dest(Address, _, Endpoint), CloneId)) :-
    agent_left(CloneId, Address, 1, Endpoint),
    ignore(with_agent(Id, clone_back(Id, CloneId, parent(CloneId)))).

%   Where it went is known before it is gone, and mail that came meanwhile
%   is on its way before any that comes now.

moved_on(Id, Hops, Address, Endpoint, Orders, Gone) :-
    agent_status(Id, transit(_, _), hop(_, Hops, _, _)),
    agent_left(Id, Address, Hops, Endpoint),
    hop_let_go(Id, Mail, Orders, Gone),
    post_on(Id, Mail).

%!  hop_let_go(+Id, -Mail, -Orders, :Gone) is semidet.
%
%   Forget Id, which is in transit; inside with_agent/2.  Gone is to be
%   called outside.

hop_let_go(Id, Mail, Orders, typhon_hop:gone(Host, Since)) :-
    agent_status(Id, transit(_, _), hop(_, _, _, Since)),
    agent(Id, Host, _, _, _),
    mail_all(Id, Mail),
    agent_all_orders(Id, Orders),
    agent_remove(Id).

gone(Host, Since) :-
    host_leave(Host),
    (   host_time(Host, Now)
    ->  Seconds is max(0.0, Now-Since),
        host_hop(Host, out, Seconds)
    ;   true                            % the host was stopped meanwhile
    ).

follow(Id, Order) :-
    scheduler_call(typhon_hop:forward_order(Id, Order)).

                /*******************************
                *            STAYS             *
                *******************************/

%   stays(+For, +Error): the agent stays; Error is raised at its move.  If
%   the move was ordered from outside there is no hole, and it is reported
%   instead.

stays(hop(Id, _, Hops), Error) :-
    retractall(given_up(Id, Hops)),
    ignore(with_agent(Id, back(Id, Hops, Error))).
stays(clone(Id, _, CloneId), Error) :-
    agent_ended(CloneId, failed, 1),
    ignore(with_agent(Id, clone_back(Id, CloneId, throw(error(Error, _))))).

back(Id, Hops, Error) :-
    agent_status(Id, transit(_, _), hop(Hole-Goals, Hops, Mail, _)),
    mail_back(Id, Mail),
    (   Hole == ordered
    ->  print_message(warning, typhon(order_failed(Id, Error)))
    ;   Hole = throw(error(Error, _))
    ),
    agent_ready(Id, Goals).

clone_back(Id, CloneId, Answer) :-
    agent_status(Id, cloning(_, _), clone(Hole-Goals-Who, CloneId, _)),
    (   Answer = parent(_)
    ->  Hole = (Who=Answer)
    ;   Hole = Answer
    ),
    agent_ready(Id, Goals).

                /*******************************
                *           IN DOUBT           *
                *******************************/

%!  hop_state(+Status, -State) is det.
%
%   State is `in_transit` or `in_doubt`: the answer is overdue, or the
%   connection on which it should come is broken.
%
%   @arg Status is transit(Address, Sent) or cloning(Address, Sent)

hop_state(Status, State) :-
    arg(1, Status, Address),
    address_parts(Address, _, Endpoint),
    (   (   endpoint_peer(Endpoint, state(down))
        ;   overdue(Status)
        )
    ->  State = in_doubt
    ;   State = in_transit
    ).

%!  hop_out_of_touch(+Status) is semidet.
%
%   The answer is overdue, and there is no connection on which it could come:
%   an order to end is not put off any longer.  Before that it follows the
%   agent.

hop_out_of_touch(Status) :-
    overdue(Status),
    arg(1, Status, Address),
    address_parts(Address, _, Endpoint),
    endpoint_peer(Endpoint, state(down)).

overdue(Status) :-
    arg(2, Status, Sent),
    get_time(Now),
    setting(doubt_seconds, Limit),
    Now-Sent > Limit.

%!  hop_given_up(+Id, +Goals) is det.
%
%   Id was disposed of in doubt, Goals being those of its status: should
%   it have arrived, the order follows it.

hop_given_up(Id, hop(_, Hops, _, _)) :-
    assertz(given_up(Id, Hops)).
