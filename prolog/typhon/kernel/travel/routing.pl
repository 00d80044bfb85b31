:- module(typhon_routing,
          [ one_letter/2,               % +Letters, -Letter
            way_in/2,                   % +Id, +Mail
            way_out/3,                  % +Id, +Letter, -Way
            way_send/3,                 % +Endpoint, +Id, +Letter
            mail_lost/3                 % +Formal, +Id, +Mail
          ]).
:- use_module(library(apply), [maplist/4, partition/4]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [append/2, append/3, max_list/2, member/2]).
:- use_module('../base/durable_changes', [durable_on/0, durable_post/3]).
:- use_module('../base/reports', [report/5]).
:- use_module('../wire',
              [ endpoint_address/1, endpoint_gone/1, endpoint_post/3,
                endpoint_post_up/3 ]).
:- use_module('../host',
              [address_parts/3, amended/5, parts/3, scheduler_call/1]).
:- use_module('../agent',
              [ agent/5, agent_home_endpoint/2, agent_mail/2,
                mail_fitting/4 ]).
:- use_module(whereabouts, [agent_outcome/2, whereabouts/2]).
:- use_module(sender_authorization,
              [mail_routes/4, senders_checked/0, with_proof/5]).

/** <module> Routing of letters, and dead letters

A letter(Mail, Left) may be forwarded Left times more.  Mail is a list of
mail(Origin, From, Message), the oldest first.

*Threading*: one_letter/2 is pure; way_in/2 and way_out/3 inside with_agent/2;
they never wait.  way_send/3 may wait for a connection; mail_lost/3 is for any
thread.
*/

:- multifile
    returned/3,                 % From, Id, Message: the bridge of From takes
                                % it back
    typhon_durable_changes:undelivered/4,
    typhon_endpoint:received/3.

%   After so many forwards without a pause the letter chases its agent in vain,
%   or processes lack news of the agent that is under way: the letter waits a
%   little.

forwards_at_once(64).

%!  one_letter(+Letters, -Letter) is det.
%
%   Letter has the mail of all Letters.

one_letter([Letter], Letter) :-
    !.
one_letter(Letters, letter(Mail, Left)) :-
    maplist(letter_parts, Letters, Mails, Lefts),
    append(Mails, Mail),
    max_list(Lefts, Left).

letter_parts(letter(Mail, Left), Mail, Left).

%!  way_in(+Id, +Mail) is semidet.
%
%   Put the part of Mail that Id, an agent of this process, accepts into its
%   mailbox; what its mailbox has no space for becomes dead letters.

way_in(Id, Mail) :-
    fitting(Id, Mail, Accepted),
    mail_fitting(Id, Accepted, Fitting, Rest),
    messages(Fitting, Messages),
    agent_mail(Id, Messages),
    ( Rest == [] -> true ; mail_lost(resource_error(mailbox), Id, Rest) ).

fitting(Id, Mail, Fitting) :-
    (   parts(deliver, _, _),
        agent(Id, Host, _, _, _)
    ->  amended(deliver, Host, Id, Mail, Fitting)
    ;   Fitting = Mail
    ).

messages([], []).
messages([mail(_, From, Message)|Mail], [From-Message|Messages]) :-
    messages(Mail, Messages).

%!  way_out(+Id, +Letter, -Way) is det.
%
%   Way is `done`, to(Endpoint, Letter) if a connection has to be made first,
%   wait(Letter) if it is better to wait, or `nowhere`.

way_out(Id, letter(Mail, Left), Way) :-
    Left > 0,
    next_endpoint(Id, Endpoint),
    !,
    Left1 is Left-1,
    Letter = letter(Mail, Left1),
    forwards_at_once(Most),
    (   (   Left1 mod Most =:= 0
        ;   Endpoint == here            % the agent is on its way in
        )
    ->  Way = wait(Letter)
    ;   sent(Endpoint, Id, Letter, endpoint_post_up)
    ->  Way = done
    ;   Way = to(Endpoint, Letter)
    ).
way_out(_, _, nowhere).

%   next_endpoint(+Id, -Endpoint): the process to which the agent went, as far
%   as this process knows, or its home.  Endpoint is `here` if it is that of
%   this process.

next_endpoint(Id, Endpoint) :-
    whereabouts(Id, Address),
    address_parts(Address, _, Endpoint0),
    \+ endpoint_gone(Endpoint0),
    !,
    (   endpoint_address(Endpoint0)
    ->  Endpoint = here
    ;   Endpoint = Endpoint0
    ).
next_endpoint(Id, Endpoint) :-
    agent_home_endpoint(Id, Endpoint),
    \+ endpoint_address(Endpoint).

%!  way_send(+Endpoint, +Id, +Letter) is det.
%
%   If the process at Endpoint, a forwarding address, is gone, the letter goes
%   to the home of the agent.
%
%   @error host_unreachable(Endpoint)

way_send(Endpoint, Id, Letter) :-
    catch(sent(Endpoint, Id, Letter, endpoint_post),
          error(unreachable(_), _),
          send_home(Endpoint, Id, Letter)).

send_home(Failed, Id, Letter) :-
    (   agent_home_endpoint(Id, Home),
        Home \== Failed,
        \+ endpoint_address(Home)
    ->  catch(sent(Home, Id, Letter, endpoint_post),
              error(unreachable(_), _),
              throw(error(host_unreachable(Home), _)))
    ;   throw(error(host_unreachable(Failed), _))
    ).

%   sent(+Endpoint, +Id, +Letter, :Post): send the mail of Letter to Endpoint,
%   except messages that another process has to forward.

sent(Endpoint, Id, letter(Mail, Left), Post) :-
    mail_routes(Endpoint, Id, Mail, Parts),
    (   Parts = [To-_]
    ->  posted(To, Id, letter(Mail, Left), Post)
    ;   Post == endpoint_post           % endpoint_post_up must not connect
    ->  forall(member(To-Part, Parts), part_sent(To, Id, Part, Left))
    ).

part_sent(Endpoint, Id, Mail, Left) :-
    catch(posted(Endpoint, Id, letter(Mail, Left), endpoint_post),
          error(unreachable(_), _),
          mail_lost(host_unreachable(Endpoint), Id, Mail)).

%   posted(+Endpoint, +Id, +Letter, :Post): a letter too long for one frame is
%   sent in two.  With a journal the post is durable, and sent when possible.

posted(Endpoint, Id, letter(Mail, Left), Post) :-
    message(Endpoint, Id, Mail, Left, Message),
    (   durable_on
    ->  By = durable_post
    ;   By = Post
    ),
    catch(call(By, Endpoint, message, Message),
          error(resource_error(frame_bytes), Context),
          sent_halves(Endpoint, Id, letter(Mail, Left), Post, Context)),
    debug(typhon(mail), '~w: a letter goes to ~w', [Id, Endpoint]).

message(Endpoint, Id, Mail, Left, Message) :-
    senders_checked,
    !,
    findall(From, member(mail(_, From, _), Mail), Froms),
    (   whereabouts(Id, Address),
        address_parts(Address, _, Endpoint)
    ->  There = [Id]
    ;   There = []
    ),
    with_proof(Endpoint, [Id|Froms], There, message(Id, Mail, Left), Message).
message(_, Id, Mail, Left, message(Id, Mail, Left)).

sent_halves(Endpoint, Id, letter(Mail, Left), Post, Context) :-
    (   halves(Mail, Older, Newer)
    ->  posted(Endpoint, Id, letter(Older, Left), Post),
        posted(Endpoint, Id, letter(Newer, Left), Post)
    ;   throw(error(resource_error(frame_bytes), Context))
    ).

halves(Mail, Older, Newer) :-
    length(Mail, Count),
    Count > 1,
    Half is Count//2,
    length(Older, Half),
    append(Older, Newer, Mail).

                /*******************************
                *         DEAD LETTERS         *
                *******************************/

%!  mail_lost(+Formal, +Id, +Mail) is det.
%
%   Report once that Mail cannot be delivered, in the process that sent it, or
%   here if there is no connection to that, unless Id has ended, which is normal.
%   A message whose sender is not an agent, but a term such as fipa(Name), is
%   returned to the bridge of the process that sent it.

mail_lost(Formal, Id, Mail) :-
    partition(is_from_bridge, Mail, Bridged, Sent),
    partition(was_sent_here, Bridged, Here, Elsewhere),
    give_back(Formal, Id, Here),
    report_to_origins(Formal, Id, Elsewhere),
    (   ( Sent == [] ; agent_outcome(Id, _) )
    ->  true
    ;   forall(of_origin(Sent, Origin, Lost),
               report_once(Origin, Formal, Id, Lost))
    ).

is_from_bridge(mail(_, From, _)) :-
    compound(From).

was_sent_here(mail(Origin, _, _)) :-
    endpoint_address(Origin).

%   A worker calls the bridge, because the bridge may have to wait.

give_back(Formal, Id, Mail) :-
    forall(member(One, Mail),
           scheduler_call(typhon_routing:given_back(Formal, Id, One))).

given_back(Formal, Id, Mail) :-
    Mail = mail(_, From, Message),
    (   returned(From, Id, Message)
    ->  true
    ;   report(Formal, Id, [Mail])
    ).

report_to_origins(Formal, Id, Mail) :-
    forall(of_origin(Mail, Origin, Lost),
           scheduler_call(report_to_origin(Origin, Formal, Id, Lost))).

report_to_origin(Origin, Formal, Id, Lost) :-
    catch(endpoint_post(Origin, message, lost(Formal, Id, Lost)),
          error(_, _),
          true).

of_origin(Mail, Origin, Lost) :-
    findall(O, member(mail(O, _, _), Mail), Origins0),
    sort(Origins0, Origins),
    member(Origin, Origins),
    findall(mail(Origin, From, Message),
            member(mail(Origin, From, Message), Mail), Lost).

report_once(Origin, Formal, Id, Lost) :-
    \+ endpoint_address(Origin),
    endpoint_post_up(Origin, message, lost(Formal, Id, Lost)),
    !.
report_once(_, Formal, Id, Lost) :-
    report(Formal, Id, Lost).

report(Formal, Id, [mail(_, From, Message)|More]) :-
    length(More, Others),
    (   More == []
    ->  Problem = undeliverable(Formal, Id, From, Message)
    ;   Problem = undeliverable(Formal, Id, From, Message, Others)
    ),
    Count is Others+1,
    report(warning, lost_messages, Id, Count, typhon(Problem)).

typhon_endpoint:received(message, lost(Formal, Id, Mail), _) :-
    partition(is_from_bridge, Mail, Bridged, Sent),
    give_back(Formal, Id, Bridged),
    (   Sent == []
    ->  true
    ;   report(Formal, Id, Sent)
    ).

typhon_durable_changes:undelivered(message, shown(_, Message), Endpoint,
                                   Formal) :-
    typhon_durable_changes:undelivered(message, Message, Endpoint, Formal).
typhon_durable_changes:undelivered(message, message(Id, Mail, _), _, Formal) :-
    mail_lost(Formal, Id, Mail).
