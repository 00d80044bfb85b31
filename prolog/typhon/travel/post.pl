:- module(typhon_post,
          [ post/3,                     % +Id, +From, +Message
            post_via/4,                 % +Id, +Endpoint, +From, +Message
            post_on/2,                  % +Id, +Messages
            post_waiting/2              % +Id, -Messages
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(lists), [append/2, append/3, member/2]).
:- use_module('../wire',
              [ endpoint_address/1, endpoint_gone/1, endpoint_post/3,
                endpoint_post_up/3, mobile_term/1 ]).
:- use_module('../host', [address_parts/3, alarm_set/3, scheduler_call/1]).
:- use_module('../agent',
              [ agent/5, agent_home/2, agent_mail/2, agent_status/3,
                with_agent/2 ]).
:- use_module(backlog,
              [ backlog/1, backlog_add/2, backlog_again/3, backlog_all/2,
                backlog_begin/3, backlog_done/1 ]).
:- use_module(whereabouts, [agent_outcome/2, whereabouts/2]).

/** <module> Messages

A message is put in the mailbox of an agent that stands in this process,
also while it is under way out of it: it then follows.  Otherwise it goes
where the agent went, or to its home, which knows.

What travels is letter(Mail, Left).  Mail is a list of
mail(Origin, From, Message), the oldest first; Origin is the endpoint at
which it was sent, to which it is told if the agent cannot be found.  What
follows an agent together stays together, so that whatever waited for one
that hops without pause reaches it at once, and not each message after a
chase of its own.

A letter that cannot be passed on waits, see typhon_backlog, and is tried
again: for as long as the next process may be alive, and for a while longer,
since the news that the agent had left it may be under way.

*Threading*: any thread.  post/3 and post_via/4 may wait for a connection,
post_on/2 and the hooks never do.
*/

:- multifile
    error:has_type/2,
    typhon_endpoint:received/3,
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2.

%   A letter that has been forwarded so often at once chases its agent in
%   vain for the moment, or those who should know do not know yet: it waits
%   a little.

max_forwards(12800).
forwards_at_once(64).

%   The pause before a backlog is tried again, for the next time.  Nobody is
%   there any more if that has been so for some tries.

pause(Tries, Seconds) :-
    Seconds is min(2.0, 0.05*2**min(Tries, 10)).

most_tries(6).

%!  post(+Id, +From, +Message) is det.
%
%   @error existence_error(agent, Id) if it is known that there is none
%   @error type_error(mobile_term, Culprit)
%   @error host_unreachable(Host)

post(Id, From, Message) :-
    mobile_term(Message),
    (   with_agent(Id, put_in(Id, [mail(here, From, Message)]))
    ->  true
    ;   new_letter(From, Message, Letter),
        with_agent(Id, way(Id, Letter, Way)),
        go(Way, Id)
    ).

new_letter(From, Message, letter([mail(Origin, From, Message)], Max)) :-
    (   endpoint_address(Origin)
    ->  true
    ;   Origin = none
    ),
    max_forwards(Max).

%!  post_via(+Id, +Endpoint, +From, +Message) is det.
%
%   As post/3, where the agent is believed to be in the process at
%   Endpoint.

post_via(Id, Endpoint, From, Message) :-
    mobile_term(Message),
    (   (   agent(Id, _, _, _, _)
        ;   endpoint_address(Endpoint)
        )
    ->  post(Id, From, Message)
    ;   new_letter(From, Message, Letter),
        send(Endpoint, Id, Letter)
    ).

%!  post_on(+Id, +Messages) is det.
%
%   As post/3 for each of Messages, From-Message, for a thread that must not
%   wait for a connection to be made.

post_on(_, []) :-
    !.
post_on(Id, Messages) :-
    endpoint_address(Origin),
    max_forwards(Max),
    findall(mail(Origin, From, Text), member(From-Text, Messages), Mail),
    pass_on(Id, letter(Mail, Max)).

pass_on(Id, Letter) :-
    with_agent(Id,
               (   way(Id, Letter, Way),
                   Way \== done
               ->  keep(Id, Letter, Way)
               ;   true
               )).

typhon_endpoint:received(message, message(Id, Mail, Left), _) :-
    must_be(atom, Id),
    must_be(nonneg, Left),
    must_be(list(typhon_mail), Mail),
    (   Mail == []
    ->  true
    ;   pass_on(Id, letter(Mail, Left))
    ).
typhon_endpoint:received(message, lost(Formal, Id, Mail), _) :-
    must_be(list(typhon_mail), Mail),
    report(Formal, Id, Mail).

error:has_type(typhon_mail, Mail) :-
    subsumes_term(mail(_, _, _), Mail),
    arg(1, Mail, Origin),
    atom(Origin).

%!  post_waiting(+Id, -Messages:list) is det.
%
%   The messages that waited here for Id, which has arrived; inside
%   with_agent/2.

post_waiting(Id, Messages) :-
    backlog_all(Id, Letters),
    findall(From-Message,
            ( member(letter(Mail, _), Letters),
              member(mail(_, From, Message), Mail) ),
            Messages).

                /*******************************
                *             WAYS             *
                *******************************/

%   way(+Id, +Letter, -Way): one step, inside with_agent/2.  Way is `done`,
%   to(Endpoint, Letter) if a connection has to be made first, wait(Letter)
%   if it is better to wait, or nowhere.

way(Id, letter(Mail, _), done) :-
    put_in(Id, Mail),
    !.
way(Id, Letter, done) :-
    backlog(Id),
    !,
    backlog_add(Id, Letter).
way(Id, Letter, Way) :-
    way_out(Id, Letter, Way).

put_in(Id, Mail) :-
    agent(Id, _, _, _, _),
    !,
    (   agent_status(Id, faulty(_), _)
    ->  true
    ;   put_all(Mail, Id)
    ).

put_all([], _).
put_all([mail(_, From, Message)|Mail], Id) :-
    agent_mail(Id, From-Message),
    put_all(Mail, Id).

way_out(Id, letter(Mail, Left), Way) :-
    Left > 0,
    next_endpoint(Id, Endpoint),
    !,
    Left1 is Left-1,
    Letter = letter(Mail, Left1),
    forwards_at_once(Most),
    (   (   Left1 mod Most =:= 0
        ;   endpoint_address(Endpoint)  % on its way in
        )
    ->  Way = wait(Letter)
    ;   sent(Endpoint, Id, Letter, endpoint_post_up)
    ->  Way = done
    ;   Way = to(Endpoint, Letter)
    ).
way_out(_, _, nowhere).

%   Who is not here has left a trace, or the home knows.

next_endpoint(Id, Endpoint) :-
    whereabouts(Id, Address),
    address_parts(Address, _, Endpoint0),
    \+ endpoint_gone(Endpoint0),
    !,
    Endpoint = Endpoint0.
next_endpoint(Id, Endpoint) :-
    home_endpoint(Id, Endpoint),
    \+ endpoint_address(Endpoint).

home_endpoint(Id, Endpoint) :-
    agent_home(Id, Home),
    address_parts(Home, _, Endpoint).

%   go(+Way, +Id): in a thread that may wait, and wants to know.

go(done, _).
go(to(Endpoint, Letter), Id) :-
    send(Endpoint, Id, Letter).
go(wait(Letter), Id) :-
    with_agent(Id, keep(Id, Letter, wait(Letter))).
go(nowhere, Id) :-
    existence_error(agent, Id).

%   Where a forwarding address leads to a process that is gone, the home
%   may know better.

send(Endpoint, Id, Letter) :-
    catch(sent(Endpoint, Id, Letter, endpoint_post),
          error(unreachable(_), _),
          send_home(Endpoint, Id, Letter)).

send_home(Failed, Id, Letter) :-
    (   home_endpoint(Id, Home),
        Home \== Failed,
        \+ endpoint_address(Home)
    ->  catch(sent(Home, Id, Letter, endpoint_post),
              error(unreachable(_), _),
              throw(error(host_unreachable(Home), _)))
    ;   throw(error(host_unreachable(Failed), _))
    ).

%   sent(+Endpoint, +Id, +Letter, :Post): what is too long for one frame goes
%   in two.

sent(Endpoint, Id, letter(Mail, Left), Post) :-
    catch(call(Post, Endpoint, message, message(Id, Mail, Left)),
          error(resource_error(frame_bytes), Context),
          (   halves(Mail, Older, Newer)
          ->  sent(Endpoint, Id, letter(Older, Left), Post),
              sent(Endpoint, Id, letter(Newer, Left), Post)
          ;   throw(error(resource_error(frame_bytes), Context))
          )).

halves(Mail, Older, Newer) :-
    length(Mail, Count),
    Count > 1,
    Half is Count//2,
    length(Older, Half),
    append(Older, Newer, Mail).

                /*******************************
                *            WAITING           *
                *******************************/

%   keep(+Id, +Letter, +Way): Letter waits; inside with_agent/2.

keep(Id, _, wait(Letter)) :-
    !,
    backlog_add(Id, Letter),
    try_later(Id, 0).
keep(Id, _, to(_, Letter)) :-
    !,
    backlog_add(Id, Letter),
    scheduler_call(typhon_post:try(Id)).
keep(Id, letter(Mail, _), nowhere) :-
    agent_outcome(Id, _),
    !,
    lost(existence_error(agent, Id), Id, Mail).
keep(Id, Letter, nowhere) :-
    backlog_add(Id, Letter),
    try_later(Id, 0).

try_later(Id, Tries) :-
    pause(Tries, Seconds),
    get_time(Now),
    Stamp is Now+Seconds,
    alarm_set(Stamp, Id, mail).

typhon_scheduler:fire(Id, mail) :-
    !,
    scheduler_call(typhon_post:try(Id)).

typhon_scheduler:over(Id, mail) :-
    \+ backlog(Id).

%   try(+Id): in a worker.

try(Id) :-
    (   with_agent(Id, backlog_begin(Id, Letters, Tries))
    ->  one_letter(Letters, Letter),
        catch(tried(Id, Letter, Way), error(Formal, _), Way = failed(Formal)),
        with_agent(Id, conclude(Way, Id, Letter, Tries))
    ;   true
    ).

one_letter(Letters, letter(Mail, Left)) :-
    findall(Some, member(letter(Some, _), Letters), Parts),
    append(Parts, Mail),
    aggregate_all(max(L), member(letter(_, L), Letters), Left).

tried(Id, Letter, Way) :-
    with_agent(Id, step(Id, Letter, Way0)),
    (   Way0 = to(Endpoint, Letter1)
    ->  send(Endpoint, Id, Letter1),
        Way = done
    ;   Way = Way0
    ).

step(Id, letter(Mail, _), done) :-
    put_in(Id, Mail),
    !.
step(Id, Letter, Way) :-
    way_out(Id, Letter, Way).

conclude(done, Id, _, _) :-
    (   backlog_done(Id)
    ->  true
    ;   scheduler_call(typhon_post:try(Id))
    ).
conclude(wait(Letter), Id, _, _) :-
    backlog_again(Id, [Letter], 0),
    try_later(Id, 0).
conclude(nowhere, Id, Letter, Tries) :-
    in_vain(Id, Letter, Tries, existence_error(agent, Id)).
conclude(failed(Formal), Id, Letter, Tries) :-
    in_vain(Id, Letter, Tries, Formal).

in_vain(Id, letter(Mail, _), Tries, Formal) :-
    hopeless(Formal, Id, Tries),
    !,
    lost(Formal, Id, Mail),
    conclude(done, Id, _, 0).
in_vain(Id, Letter, Tries, _) :-
    Tries1 is Tries+1,
    backlog_again(Id, [Letter], Tries1),
    try_later(Id, Tries1).

hopeless(existence_error(agent, Id), Id, Tries) :-
    (   agent_outcome(Id, _)
    ->  true
    ;   most_tries(Most),
        Tries >= Most
    ).
hopeless(host_unreachable(Endpoint), _, Tries) :-
    endpoint_gone(Endpoint),
    most_tries(Most),
    Tries >= Most.
hopeless(resource_error(_), _, _).
hopeless(existence_error(endpoint, _), _, _).   % this process ends

                /*******************************
                *             LOST             *
                *******************************/

%   lost(+Formal, +Id, +Mail): said here and where it was sent.  That an agent
%   has ended is nothing special.

lost(_, Id, _) :-
    agent_outcome(Id, _),
    !.
lost(Formal, Id, Mail) :-
    report(Formal, Id, Mail),
    findall(Origin, member(mail(Origin, _, _), Mail), Origins0),
    sort(Origins0, Origins),
    forall(( member(Origin, Origins), \+ endpoint_address(Origin) ),
           scheduler_call(typhon_post:tell_origin(Origin, Formal, Id, Mail))).

tell_origin(Origin, Formal, Id, Mail) :-
    findall(mail(Origin, From, Message),
            member(mail(Origin, From, Message), Mail), Lost),
    catch(endpoint_post(Origin, message, lost(Formal, Id, Lost)),
          error(unreachable(_), _),
          true).                        % gone, and it was said here

report(Formal, Id, [mail(_, From, Message)|More]) :-
    (   More == []
    ->  Told = undeliverable(Formal, Id, From, Message)
    ;   length(More, Others),
        Told = undeliverable(Formal, Id, From, Message, Others)
    ),
    print_message(warning, typhon(Told)).
