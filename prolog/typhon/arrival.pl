:- module(typhon_arrival, []).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(agent).
:- use_module(clock, [host_time/2]).
:- use_module(code, [code_install/2, code_module/2]).
:- use_module(endpoint, [endpoint_reply/2, endpoint_reply_later/2]).
:- use_module(hop, [hop_let_go/4]).
:- use_module(host, [host/3, host_enter/3, host_leave/1, host_hop/3]).
:- use_module(scheduler, [schedule/2]).
:- use_module(whereabouts, [agent_seen/4, whereabouts/3, agent_outcome/2]).

/** <module> Agents arrive

The other half of a hop, see typhon_hop: install what comes and answer.  A
transfer that comes again is recognised by what is known anyhow: the agent
stands here, has gone on, or has ended.

*Threading*: the reader threads of the endpoint.
*/

:- multifile typhon_endpoint:requested/4.

typhon_endpoint:requested(hop, hop(Name, Image, Program), Peer, ReplyTo) :-
    catch(arrive(Name, Image, Program, Peer, Answer),
          error(Formal, Context),
          ( print_message(error, error(Formal, Context)),
            Answer = refused(error(Formal))
          )),
    answer(Answer, Name, ReplyTo).

%   The agent must not run before the answer is on its way: what it sends
%   comes behind it.

answer(installed(Id), Name, ReplyTo) :-
    !,
    endpoint_reply_later(ReplyTo, accepted),
    schedule(Name, Id).
answer(Answer, _, ReplyTo) :-
    endpoint_reply(ReplyTo, Answer).

arrive(Name, Image, Program, Peer, Answer) :-
    Image = image(Id, Hash, Life, _, _, _, _),
    (   repeated(Id, Life)
    ->  Answer = accepted
    ;   \+ has_code(Hash, Program)
    ->  Answer = need_program
    ;   arg(4, Life, Tokens),
        host_enter(Name, Tokens, Entered),
        admitted(Entered, Name, Image, Peer, Answer)
    ).

repeated(Id, Life) :-
    arg(2, Life, Hops),
    (   agent(Id, _, _, _, Life0)
    ->  arg(2, Life0, Hops0),
        Hops0 >= Hops
    ;   agent_outcome(Id, _)
    ->  true
    ;   whereabouts(Id, _, Hops0),
        Hops0 >= Hops
    ).

has_code(Hash, Program) :-
    (   code_module(Hash, _)
    ->  true
    ;   Program \== known,
        code_install(Hash, Program)
    ).

admitted(refused(Reason), _, _, _, refused(Reason)).
admitted(ok, Name, Image, Peer, Answer) :-
    (   catch(install(Name, Image, Peer), Ball,
              ( host_leave(Name), throw(Ball) ))
    ->  arg(1, Image, Id),
        Answer = installed(Id)
    ;   host_leave(Name),
        not_installed(Name, Image, Answer)
    ).

%   The host was stopped, or the program thrown out, since we looked; or
%   there are two agents of this id, one of which was taken for dead: the
%   one that is here stays.

not_installed(Name, _, refused(unknown_host)) :-
    \+ host(Name, _, _),
    !.
not_installed(_, image(Id, _, Life, _, _, _, _), accepted) :-
    (   agent(Id, _, _, _, _)
    ;   repeated(Id, Life)
    ),
    !.
not_installed(_, _, need_program).

install(Name, Image, Peer) :-
    Image = image(Id, _, Life, _, _, _, Since),
    host(Name, Address, Place),
    with_agent(Id, install(Image, Name, Place, Gone)),
    call(Gone),
    arg(2, Life, Hops),
    agent_seen(Id, Address, Hops, Peer),
    host_time(Name, Now),
    Seconds is max(0.0, Now-Since),
    host_hop(Name, in, Seconds).

install(image(Id, Hash, Life, State, Goals, Mail0, _), Name, Place, Gone) :-
    code_module(Hash, _),
    came_back(Id, Life, Later, Orders, Gone),
    agent_install(Id, Name, Place, Hash, Life, State),
    agent_put(Id, ready, Goals),
    append(Mail0, Later, Mail),
    forall(member(Message, Mail), agent_mail(Id, Message)),
    forall(member(Order, Orders), agent_order(Id, Order)).

%   Our own copy, still waiting for the answer, is out of date; unless this
%   one is, since we looked.

came_back(Id, Life, Mail, Orders, Gone) :-
    \+ repeated(Id, Life),
    (   agent(Id, _, _, _, _)
    ->  hop_let_go(Id, Mail, Orders, Gone)
    ;   Mail = [],
        Orders = [],
        Gone = true
    ).
