:- module(typhon_hop,
          [ hop/6,                      % +Id, +Where, +Hole, +Goals, +Since,
                                        % -Next
            hop_clone/6,                % +Id, +Where, +CloneId, -Role, +Hole,
                                        % +Goals
            hand_over/5,                % +Id, +Host, +Where, +Hole, +Goals
            taken_over/4,               % +Host, +Image, +Program, +Peer
            transfer_parcel/2,          % +Transfer, -Parcel
            hop_at_once/6               % +Id, +Here, +Host, +Hole, +Goals,
                                        % -Next
          ]).

/** <module> A hop is a transaction

In a hop of the general form the source keeps the agent until the answer. It
freezes the agent and sends its image: state, payloads, goals, mail. The
receiver installs it and answers, see typhon_arrival; only then does the source
remove its copy, see typhon_transfer. If the agent comes back before the
answer, it has arrived.

  | answer       | the source                                            |
  | ------------ | ----------------------------------------------------- |
  | accepted     | removes the agent; forwards mail that came meanwhile  |
  | refused(Why) | raises move_refused(Host, Why) at the move            |
  | need_program | sends again, with the program                         |
  | unreachable  | raises host_unreachable(Host) at the move             |
  | lost         | asks whether the agent arrived, see typhon_transfer   |

_Between plain hosts_: an agent that leaves a host without parts, see
typhon_host_parts, for another process is handed over. The source keeps only
the sent frame, and settlement of the frame means that the agent has arrived.
No request is open, no goals are copied, and no module is kept.

In any other case, and when a predicate reads the agent meanwhile, the agent is
_thawed_: the frame is decoded, and the agent is in transit like one that was
sent by request, see typhon_transfer, which does the rest.

An agent that comes to a host without parts is taken over in one step, and
continues in the thread that has read it, if its turns are short.  In any
unusual case this step fails without changes; then the agent arrives like any
other, see typhon_arrival.

_Within a process_ no image is sent, and no transfer can be in doubt: the
record of the agent changes in one step. Its mail and orders stay where they
are, and mostly its state does, too. To the agent the hop is like any other:
its terms must be mobile, and its place changes. Only the bound on the length
of a frame does not apply.

*Threading*: hop/6, hand_over/5 and hop_at_once/6 in a worker, which has the
agent; answers and taken_over/4 in the threads of the endpoint, which never wait.
*/

:- use_module(library(debug), [debug/3]).
:- use_module('../agent',
              [ agent/5, agent_build/5, agent_enter/5, agent_remove/3,
                agent_hand_over/4, agent_here/5, agent_links/4, agent_mobile/6,
                agent_module/4, agent_move/5, agent_on/2, agent_replace/6,
                agent_put/3, agent_ready/2, agent_relink/2, agent_rests/3,
                agent_departing/7, agent_state/2, agent_state_mobile/4,
                agent_status/3, agent_thawed/5, agent_under_way/6, gate/4,
                image_amended/5, image_handed/7, image_hash/2, image_held/2,
                image_plain/8, life_before/2, life_hop/3,
                mail_all/2, mail_back/2,
                mail_waits/1, program_missing/2, program_sent/3, with_agent/2 ]).
:- use_module('../base/durable',
              [commits_must_succeed/0, crash_point/1, durable_on/0]).
:- use_module('../base/error_text', [print_error/2]).
:- use_module('../host',
              [ address_parts/3, amended/5, event/4, event_subscribed/1,
                hosts_apart/2, host/3, host_arrival/2, host_landing/4, host_departure/2,
                host_moved/4, host_passage/6, host_passes/2,
                host_plain_departure/2, host_time/2, parts/3, real_time/3,
                schedule/2, schedule_here/3, schedule_stays/2,
                scheduler_call/1 ]).
:- use_module('../program', [code_compiled/2, code_sent/2, plain_goals/2]).
:- use_module('../wire',
              [ endpoint_address/1, endpoint_afterwards/1, endpoint_hand/4,
                endpoint_hand_over/2, endpoint_hand_to/2, endpoint_handed/2,
                endpoint_request/4, mobile_term/1 ]).
:- use_module(mail, [backlog/1, post_on/2]).
:- use_module(outcomes, [clone_born/2]).
:- use_module(transfer,
              [ hop_label/3, may_have_arrived/1, move_over/2,
                resolve_in_doubt/1, transfer_arrived/1, transfer_freeze/4,
                transfer_image/2, transfer_image/3, transfer_image/5,
                transfer_stays/2,
                transfer_traveller/3, transfer_unpark/1,
                transfer_unreachable/1 ]).
:- use_module(whereabouts,
              [ agent_arrived/4, agent_born/2, agent_departed/4, hop_is_new/3,
                visitor_arrived/4 ]).

:- multifile
    sent_again/2,                       % Endpoint, Id: the image is sent again,
                                        % as the receiver lacks the program and
                                        % its proofs
    typhon_transfer:again/1,
    typhon_agents:thaw/1,
    typhon_endpoint:handed_over/2.

:- public settled/2.

%!  hop(+Id, +Where, +Hole, +Goals, +Since, -Next) is det.
%
%   Send Id to Where, as in host_resolve/2, where it continues with Goals, Hole
%   bound to `true`.  Next is `stop`, or elsewhere(Name, Module, Goals) if this
%   worker is to continue the agent there, with its state in Module.
%
%   @arg Since is the host time of its departure
%   @error type_error(mobile_term, Culprit)
%   @error move_refused(Address, Reason), of a host of this process

hop(Id, local(Name), Hole0, Goals, Since, Next) :-
    \+ cut_off(Id, Name),
    !,
    ( nonvar(Hole0), Hole0 = wait(Hole, _) -> true ; Hole = Hole0 ),
    hop_within(Id, Name, Hole, Goals, Since, Next).
hop(Id, Where, Hole, Goals0, Since, stop) :-
    plain_goals(Goals0, Goals),
    destination(Where, Dest),
    Transfer = transfer(Id, Dest, _),
    image(Transfer, Hole-Goals, Mail, Since, Image),
    set_out(Transfer, Hole-Goals, Mail, Since, Image).

%!  hop_clone(+Id, +Where, +CloneId, -Role, +Hole, +Goals) is det.
%
%   Send a clone of Id to Where; Id waits for the answer, and Goals are its
%   goals.

hop_clone(Id, Where, CloneId, Role, Hole, Goals0) :-
    plain_goals(Goals0, Goals),
    agent(Id, Host, _, _, _),
    host_time(Host, Since),
    destination(Where, Dest),
    Transfer = clone_transfer(Id, Dest, CloneId),
    image(Transfer, Hole-Goals-Role, Mail, Since, Image),
    host(Host, Here, _),
    agent_born(CloneId, Here),
    clone_born(Id, CloneId),
    set_out(Transfer, Hole-Goals-Role, Mail, Since, Image).

%   The host of this process may be stopped while an agent is on its way to it;
%   its address stays the same.

destination(local(Name), dest(Address, Name, Endpoint)) :-
    endpoint_address(Endpoint),
    address_parts(Address, Name, Endpoint).
destination(remote(Address, Name, Endpoint), dest(Address, Name, Endpoint)).

%   Mail stays unbound until the agent is frozen.

image(Transfer, Held, Mail, Since, Image) :-
    copy_term(Held, Going),
    transfer_image(Transfer, Going, Mail, Since, Image),
    mobile_term(Image).

%   An interrupt comes before or after both steps; between them it would leave
%   an agent that waits for the answer to an image that was never sent.

set_out(Transfer, Held, Mail, Since, Image) :-
    sig_atomic(freeze_and_send(Transfer, Held, Mail, Since, Image)).

freeze_and_send(Transfer, Held, Mail, Since, Image) :-
    arg(1, Transfer, Id),
    (   with_agent(Id, transfer_freeze(Transfer, Held, Mail, Since))
    ->  send(Transfer, Image)
    ;   true                            % it was ended meanwhile
    ).

cut_off(Id, Name) :-
    agent_on(Id, Here),
    hosts_apart(Here, Name).

%   send(+Transfer, +Image): if the image cannot be sent, for example because
%   its frame is too long, the agent stays.

send(Transfer, _) :-
    parts(away, _, _),
    arg(1, Transfer, Id),
    arg(2, Transfer, dest(_, Name, Endpoint)),
    endpoint_address(Endpoint),
    cut_off(Id, Name),
    !,
    transfer_unreachable(Transfer).
send(Transfer, Image) :-
    catch(send_image(Transfer, Image),
          error(Formal, _),
          not_sent(Formal, Transfer)).

send_image(Transfer, Image0) :-
    arg(2, Transfer, dest(_, Name, Endpoint)),
    amended_image(Transfer, program_sent(Endpoint), Image0, Image, Program),
    (   durable_on
    ->  commits_must_succeed,
        hop_request(Transfer, Name, Image, Program, Request),
        endpoint_request(Endpoint, hop, Request, answered(Transfer)),
        crash_point(after_send)
    ;   handed(Endpoint, hop(Name, Image, Program), Transfer)
    ->  true
    ;   endpoint_request(Endpoint, hop, hop(Name, Image, Program),
                         answered(Transfer))
    ).

%   amended_image(+Transfer, :Sent, +Image0, -Image, -Program): what is sent;
%   options of the host add to it.  call(Sent, Hash, Program0) gives its program.

:- meta_predicate amended_image(+, 2, +, -, -).

amended_image(Transfer, Sent, Image0, Image, Program) :-
    parts(departs, _, _),
    arg(1, Transfer, Id),
    agent(Id, Host, _, _, _),           % else it was ended meanwhile
    !,
    arg(2, Transfer, dest(Address, _, Endpoint)),
    image_amended(departs, Host, Address, Image0, Image),
    image_hash(Image0, Hash),
    call(Sent, Hash, Program0),
    transfer_traveller(Transfer, Agent, _),
    amended(papers, Host, program(Agent, Hash, Endpoint), Program0, Program).
amended_image(_, Sent, Image, Image, Program) :-
    image_hash(Image, Hash),
    call(Sent, Hash, Program).

%   Without a journal the hop needs no answer: settlement of its frame means
%   that it was accepted.  Fails if there is no connection.

handed(Endpoint, hop(Name, Image0, Program), Transfer) :-
    image_held(Image0, Image),
    endpoint_hand(Endpoint, hop, hop(Name, Image, Program), Hand),
    catch(sig_atomic(endpoint_hand_over(Hand, Transfer)),
          error(session_closed, _), fail).

hop_request(Transfer, Name, Image, Program, Request) :-
    transfer_traveller(Transfer, Agent, _),
    arg(2, Transfer, dest(_, _, Endpoint)),
    (   hop_label(Agent, Endpoint, Label)
    ->  Request = hop(Name, Image, Program, Label)
    ;   Request = hop(Name, Image, Program)
    ).

%!  transfer_parcel(+Transfer, -Parcel) is semidet.
%
%   Parcel is the agent of Transfer, with its program, as a term that can be kept
%   elsewhere, see typhon_arrival: parcel(From, To, Image, Held, Program), where
%   Held is for its return.  Fails if the agent was given up.

transfer_parcel(Transfer, parcel(From, To, Image, Held, Program)) :-
    Transfer = transfer(Id, dest(To, _, _), _),
    agent(Id, Host, _, _, _),
    host(Host, From, _),
    transfer_image(Transfer, Image0, Held),
    amended_image(Transfer, code_sent, Image0, Image, Program).

not_sent(Formal, Transfer) :-
    (   may_have_arrived(Transfer)
    ->  resolve_in_doubt(Transfer)
    ;   transfer_stays(Transfer, Formal)
    ).

%   Send the agent once more.

typhon_transfer:again(Transfer) :-
    transfer_unpark(Transfer),
    (   transfer_image(Transfer, Image)
    ->  send(Transfer, Image)
    ;   transfer_stays(Transfer, given_up)
    ).

                /*******************************
                *            ANSWERS           *
                *******************************/

%   result(+Result, +Transfer): the agent is in transit; treat Result as the
%   answer to its request.

result(unsent, Transfer) :-
    !,
    typhon_transfer:again(Transfer).
result(lost, Transfer) :-
    !,
    answered(Transfer, lost).
result(Answer, Transfer) :-
    answered(Transfer, answer(Answer)).

answered(Transfer, answer(Answer)) :-
    handle_answer(Answer, Transfer).
answered(Transfer, unreachable) :-
    (   may_have_arrived(Transfer)
    ->  resolve_in_doubt(Transfer)
    ;   transfer_unreachable(Transfer)
    ).
answered(Transfer, lost) :-
    resolve_in_doubt(Transfer).

handle_answer(accepted, Transfer) :-
    transfer_arrived(Transfer).
handle_answer(refused(Reason), Transfer) :-
    arg(2, Transfer, dest(Address, _, _)),
    transfer_stays(Transfer, move_refused(Address, Reason)).
handle_answer(need_program, Transfer) :-
    (   transfer_image(Transfer, Image)
    ->  arg(2, Transfer, dest(_, _, Endpoint)),
        debug(typhon(hop), '~w lacks the program', [Endpoint]),
        image_hash(Image, Hash),
        program_missing(Endpoint, Hash),
        transfer_traveller(Transfer, Agent, _),
        forall(sent_again(Endpoint, Agent), true),
        send(Transfer, Image)
    ;   transfer_stays(Transfer, given_up)
    ).

                /*******************************
                *      TO ANOTHER PROCESS      *
                *******************************/

%!  hand_over(+Id, +Host, +Where, +Hole, +Goals) is semidet.
%
%   Send Id, which moves from Host, to Where, as in host_resolve/2, where it
%   continues with Goals, Hole bound to `true`.  Fails without changes if the
%   agent has to go by request: options are in use, there is no connection, its
%   terms cannot travel, it may not move, or it has an order.

hand_over(Id, Host, remote(Address, Name, Endpoint), Hole, Goals) :-
    host_plain_departure(Host, Since),
    \+ durable_on,
    \+ event_subscribed(hops),
    agent_departing(Id, Host, Module, Hash, Life, Hops, _),
    !,
    agent_state(Module, State),
    (   mail_waits(Id)
    ->  with_agent(Id, mail_all(Id, Mail))
    ;   Mail = []
    ),
    plain_goals(Goals, Plain),
    image_handed(Id-Hash, Life, State, Hole-Plain, Mail, Since, Image),
    (   framed(Endpoint, Name, Hash, Image, Frame),
        Transfer = transfer(Id, dest(Address, Name, Endpoint), Hops),
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
    Transfer = transfer(Id, Dest, Hops),
    agent_hand_over(Id, Hops, way(Dest, Since), Frame),
    catch(endpoint_hand_over(Frame, Transfer), error(session_closed, _),
          scheduler_call(typhon_hop:settled(unsent, Transfer))).

                /*******************************
                *            RESULTS           *
                *******************************/

typhon_endpoint:handed_over(Transfer, Result) :-
    settled(Result, Transfer).

settled(accepted, transfer(Id, Dest, Hops)) :-
    with_agent(Id, departed(Id, Dest, Hops, Host, Since)),
    !,
    host_departure(Host, Since).
settled(Result, Transfer) :-
    ignore(( Transfer = transfer(Id, _, _),
             with_agent(Id, thawed(Id)) )),
    result(Result, Transfer).

%   The destination is noted before the agent is removed, and mail that came
%   meanwhile is sent before any that comes later.

departed(Id, dest(Address, _, _), Hops, Host, Since) :-
    agent_under_way(Id, Hops, Host, _, way(_, Since), Frame),
    endpoint_hand_to(Frame, Process),
    agent_departed(Id, Address, Hops, Process),
    agent_remove(Id, Hops, Mail),
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
    image_handed(Id-Hash, Life1, State, Hole-Goals0, Mail, _, Image),
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
    host_landing(Host, Address, Place, Landing),
    \+ event_subscribed(hops),
    image_plain(Image, Id, Hash, Life, Hops, Clauses, Goals, Since),
    code_compiled(Hash, Program),
    with_agent(Id, install(Id, Hops, Host-Place, Landing, Hash-Program, Life,
                           Clauses, Since, Home)),
    !,
    debug(typhon(hop), '~w hop ~D: is on ~w, from ~w',
          [Id, Hops, Address, Peer]),
    (   Home == here
    ->  true                            % this process is its home
    ;   visitor_arrived(Id, Address, Hops, Peer)
    ),
    endpoint_afterwards(go_on(Id, Host-Hash, context(Program, Id), Goals)).

%   Signals are deferred, see reader.pl: none interrupts these steps.

install(Id, Hops, Host-Place, Landing, Hash-Program, Life, Clauses, Since,
        Home) :-
    \+ agent_on(Id, _),
    \+ backlog(Id),
    hop_is_new(Id, Hops, Home),
    agent_module(Id, Place, Program, Clauses),
    (   host_arrival(Landing, Since)
    ->  agent_enter(Id, Host, Id, Hash, Life)
    ;   '$destroy_module'(Id),
        fail
    ).

go_on(Id, Host-Hash, Context, Goals, here) :-
    schedule_here(Host, Hash,
                  typhon_scheduler:run_on(Id, Host, Context, Goals)).
go_on(Id, _, _, Goals, later) :-
    ignore(with_agent(Id, agent_ready(Id, Goals))).

                /*******************************
                *       WITHIN A PROCESS       *
                *******************************/

%!  hop_at_once(+Id, +Here, +Host, +Hole, +Goals, -Next) is semidet.
%
%   As hop_within/6, between plain hosts, for an agent that moves from Here to
%   Host, a name or an address, may move and carries no extras, if hops are not
%   delayed and have no listener.  In all other cases it fails without changes.

hop_at_once(Id, Here, Host, Hole, Goals, Next) :-
    host_passage(Here, Host, _, There, Places, Passage),
    \+ event_subscribed(hops),
    hop_plain(Id, Here-There, Places-Passage, Hole-Goals, Next).

%   hop_plain(+Id, +Hosts, +Way, +Held, -Next) is semidet: between plain hosts.

hop_plain(Id, Here-There, Way, Hole-Goals, Next) :-
    agent_departing(Id, Here, Module, Hash, Life, Hops, Until0),
    !,
    agent_state_mobile(Module, Until0, Until, free),
    mobile_term(Life-Goals),
    Going = going(Module, Hash, Life, Until),
    sig_atomic(passed(Id, Here-There, Way, Going, Hole-Goals, Hops, Next)).

passed(Id, Here-(Name-Address), Way, Going, Held, Hops, Next) :-
    with_agent(Id, pass(Id, Here-Name, Way, Going, Held, Next, Seconds)),
    arrival_finish_safely(Id, Here-Name, Address, Hops, Seconds, Next).

%   pass(+Id, +Hosts, +Way, +Going, +Held, -Next, -Seconds) is semidet: if there
%   is capacity.  In all other cases it fails without changes.

pass(Id, Here-Name, (Place0-Place)-Passage, going(Module, Hash, Life, Until),
     Hole-Goals, Next, Seconds) :-
    agent_here(Id, Here, Module, _, _),
    \+ agent_rests(Id, _, _),           % it runs
    agent_links(Module, Place0, Place, Links),
    host_passes(Passage, Seconds),
    !,
    agent_relink(Module, Links),
    ( Hole = true -> true ; true ),     % no hole
    agent_replace(Id, Name, Module, Hash, Life, Until),
    (   schedule_stays(Here, Name)
    ->  Next = elsewhere(Name, Module, Goals)
    ;   Next = stop,
        agent_put(Id, ready, Goals)
    ).

%!  hop_within(+Id, +Name, +Hole, +Goals, +Since, -Next) is det.
%
%   Id, which departed at Since, is on host Name of this process, with Goals,
%   its Hole bound to `true`; or it was ended meanwhile.  Next is `stop`, or
%   elsewhere(Name, Module, Goals) if it keeps its worker.
%
%   @error type_error(mobile_term, Culprit)
%   @error move_refused(Address, Reason)

hop_within(Id, Name, Hole, Goals, Since, Next) :-
    agent_here(Id, Here, _, _, _),
    host_passage(Here, Name, Since, There, Places, Passage),
    hop_plain(Id, Here-There, Places-Passage, Hole-Goals, Next),
    !.
hop_within(Id, Name, Hole, Goals, Since, Next) :-
    agent_mobile(Id, Here, Module, Hash, Life0, Until0),
    !,
    life_hop(Life0, Life, Hops),
    agent_state_mobile(Module, Until0, Until, Bound),
    mobile_term(Life-Goals),
    Going = going(Module, Hash, Life, Until, Since, Bound),
    gate(Name, going-entrant(Id, Hash, Life, module(Module), []),
         moved(Id, Here-Name, Going, Hole-Goals, Hops, Next), Verdict),
    conclude(Verdict, Id, Here-Name, Hops, Next).
hop_within(_, _, _, _, _, stop).        % it was ended

conclude(ok, _, _, _, _).
conclude(ended, _, _, _, stop).
conclude(refused(Reason), Id, Here-Name, Hops, _) :-
    endpoint_address(Own),
    address_parts(Address, Name, Own),
    debug(typhon(hop), '~w hop ~D: stays, ~w', [Id, Hops, Reason]),
    event(hops, Here, Id, stayed(Address)),
    throw(error(move_refused(Address, Reason), _)).

%   moved(+Id, +Hosts, +Going, +Held, +Hops, -Next, -Verdict): Verdict is `ok`,
%   `ended`, or refused(unknown_host) of a host that is being stopped.

moved(Id, Hosts, Going, Held, Hops, Next, ok) :-
    with_agent(Id, move(Id, Hosts, Going, Held, Next, Seconds)),
    !,
    Hosts = _-Name,
    (   host(Name, Address, _)
    ->  arrival_finish_safely(Id, Hosts, Address, Hops, Seconds, Next)
    ;   true                            % it is being stopped
    ).
moved(Id, _, _, _, _, _, Verdict) :-
    (   agent(Id, _, _, _, _)
    ->  Verdict = refused(unknown_host)
    ;   Verdict = ended
    ).

%   An agent that was ordered to move has no hole.  Here and Name are counted
%   inside with_agent/2, so that an order to end the agent finds it counted on
%   the host where it is.

move(Id, Here-Name, going(Module0, Hash, Life, Until, Since, Bound),
     Hole-Goals0, Next, Seconds) :-
    host(Name, _, Place),
    agent_status(Id, Status, _),
    (   Bound == free,
        host(Here, _, Place0),
        agent_links(Module0, Place0, Place, Links)
    ->  Module = Module0,
        Goals = Goals0,
        agent_relink(Module, Links)
    ;   agent_state(Module0, State),
        agent_build(Id, Place, Hash, State-Goals0, Module-Goals)
    ),
    ignore(Hole = true),
    agent_move(Id, Name, Module, Life, Until),
    (   Status == running,
        schedule_stays(Here, Name)
    ->  Next = elsewhere(Name, Module, Goals)
    ;   Next = stop,
        agent_put(Id, ready, Goals)
    ),
    host_moved(Here, Name, Since, Seconds).

%   The agent has moved: errors in reporting are only printed.

arrival_finish_safely(Id, Hosts, Address, Hops, Seconds, Next) :-
    catch(arrival_finish(Id, Hosts, Address, Hops, Seconds, Next),
          error(Formal, Context),
          print_error(error, error(Formal, Context))).

arrival_finish(Id, Here-Name, Address, Hops, Seconds, Next) :-
    debug(typhon(hop), '~w hop ~D: is on ~w, of this process',
          [Id, Hops, Address]),
    agent_arrived(Id, Address, Hops, here),
    ( move_over(Id, answer(arrived)) -> true ; true ),
    (   event_subscribed(hops),
        host(Here, From, _)
    ->  event(hops, Name, Id, arrived(From, Seconds))
    ;   true
    ),
    (   Next == stop
    ->  schedule(Name, Id)
    ;   true
    ).
