:- module(typhon_hop,
          [ hop/6,                      % +Id, +Where, +Hole, +Goals, +Since,
                                        % -Next
            hop_clone/6                 % +Id, +Where, +CloneId, -Role, +Hole,
                                        % +Goals
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module('../program', [plain_goals/2]).
:- use_module('../wire',
              [ endpoint_address/1, endpoint_hand/4, endpoint_hand_over/2,
                endpoint_request/4, mobile_term/1 ]).
:- use_module('../host',
              [address_parts/3, amended/5, host/3, host_time/2, parts/3]).
:- use_module('../agent',
              [ agent/5, image_amended/5, image_hash/2, image_held/2,
                program_missing/2, program_sent/3, with_agent/2 ]).
:- use_module('../base/durable_changes',
              [commits_must_succeed/0, crash_point/1, durable_on/0]).
:- use_module(in_doubt, [may_have_arrived/1, resolve_in_doubt/1]).
:- use_module(whereabouts, [agent_born/2]).
:- use_module(hand_over, []).
:- use_module(outcomes, [clone_born/2]).
:- use_module(within, [hop_within/6]).
:- use_module(transfer,
              [ hop_label/3, transfer_arrived/1, transfer_freeze/4,
                transfer_image/2, transfer_image/5, transfer_stays/2,
                transfer_traveller/3, transfer_unreachable/1 ]).

/** <module> A hop is a transaction

This module makes hops in which the source keeps the agent until the answer.
See typhon_within for hops between hosts of one process, and typhon_hand_over
for the short form between plain hosts.  The source freezes the agent and sends
its image: state, payloads, goals, mail.  The receiver installs it and answers,
see typhon_arrival; only then does the source remove its copy, see
typhon_transfer.  If the agent comes back before the answer, it has arrived.

  | answer       | the source                                            |
  | ------------ | ----------------------------------------------------- |
  | accepted     | removes the agent; forwards mail that came meanwhile  |
  | refused(Why) | raises move_refused(Host, Why) at the move            |
  | need_program | sends again, with the program                         |
  | unreachable  | raises host_unreachable(Host) at the move             |
  | lost         | asks whether the agent arrived, see typhon_in_doubt   |

*Threading*: hop/6 in a worker; answers in the reader threads of the
endpoint, which never wait.
*/

:- multifile
    sent_again/2,               % Endpoint, Id: the image is sent again, because
                                % the receiver lacks the program and its proofs
    typhon_in_doubt:again/1,
    typhon_hand_over:result/2.

%!  hop(+Id, +Where, +Hole, +Goals, +Since, -Next) is det.
%
%   Send Id to Where, as in host_resolve/2, where it continues with Goals, Hole
%   bound to `true`.  Next is `stop`, or elsewhere(Goals) if this worker is to
%   continue the agent there.
%
%   @arg Since is the host time of its departure
%   @error type_error(mobile_term, Culprit)
%   @error move_refused(Address, Reason), of a host of this process

hop(Id, local(Name), Hole, Goals, Since, Next) :-
    !,
    hop_within(Id, Name, Hole, Goals, Since, Next).
hop(Id, Where, Hole, Goals0, Since, stop) :-
    plain_goals(Goals0, Goals),
    destination(Where, Dest),
    Transfer = hop(Id, Dest, _),
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
    Transfer = clone(Id, Dest, CloneId),
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

%   send(+Transfer, +Image): if the image cannot be sent, for example because
%   its frame is too long, the agent stays.

send(Transfer, Image0) :-
    arg(2, Transfer, dest(Address, Name, Endpoint)),
    image_hash(Image0, Hash),
    catch(( (   parts(departs, _, _),
                arg(1, Transfer, Id),
                agent(Id, Host, _, _, _) % else it was ended meanwhile
            ->  image_amended(departs, Host, Address, Image0, Image),
                program_sent(Endpoint, Hash, Sent),
                transfer_traveller(Transfer, Agent, _),
                amended(papers, Host, program(Agent, Hash, Endpoint), Sent,
                        Program)
            ;   Image = Image0,
                program_sent(Endpoint, Hash, Program)
            ),
            (   durable_on
            ->  commits_must_succeed,
                hop_request(Transfer, Name, Image, Program, Request),
                endpoint_request(Endpoint, hop, Request, answered(Transfer)),
                crash_point(after_send)
            ;   handed(Endpoint, hop(Name, Image, Program), Transfer)
            ->  true
            ;   endpoint_request(Endpoint, hop, hop(Name, Image, Program),
                                 answered(Transfer))
            )
          ),
          error(Formal, _),
          not_sent(Formal, Transfer)).

%   Without a journal the hop needs no answer: settlement of its frame means
%   that it was accepted, see typhon_hand_over.  Fails if there is no
%   connection.

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

not_sent(Formal, Transfer) :-
    (   may_have_arrived(Transfer)
    ->  resolve_in_doubt(Transfer)
    ;   transfer_stays(Transfer, Formal)
    ).

%   Send the agent once more.

typhon_in_doubt:again(Transfer) :-
    again(Transfer).

again(Transfer) :-
    (   transfer_image(Transfer, Image)
    ->  send(Transfer, Image)
    ;   transfer_stays(Transfer, given_up)
    ).

                /*******************************
                *            ANSWERS           *
                *******************************/

typhon_hand_over:result(unsent, Transfer) :-
    !,
    again(Transfer).
typhon_hand_over:result(lost, Transfer) :-
    !,
    answered(Transfer, lost).
typhon_hand_over:result(Answer, Transfer) :-
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
