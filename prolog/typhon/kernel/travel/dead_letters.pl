:- module(typhon_dead_letters,
          [ mail_lost/3                 % +Formal, +Id, +Mail
          ]).
:- use_module(library(apply), [partition/4]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module('../wire', [endpoint_address/1, endpoint_post/3]).
:- use_module('../host', [scheduler_call/1]).
:- use_module(home, [agent_outcome/2]).

/** <module> Dead letters: messages that cannot be delivered

*Threading*: any thread.
*/

:- multifile
    returned/3,                 % From, Id, Message: the bridge of From takes
                                % it back
    error:has_type/2,
    typhon_durable_posts:undelivered/4,
    typhon_endpoint:received/3.

%!  mail_lost(+Formal, +Id, +Mail) is det.
%
%   Report that Mail cannot be delivered, here and to the process that sent it,
%   unless Id has ended, which is normal.  A message of a bridge, whose sender
%   is no agent, as fipa(Name), is returned to the bridge of its process.

mail_lost(Formal, Id, Mail) :-
    partition(is_brought, Mail, Brought, Sent),
    partition(was_sent_here, Brought, Here, Elsewhere),
    give_back(Formal, Id, Here),
    tell_origins(Formal, Id, Elsewhere),
    (   ( Sent == [] ; agent_outcome(Id, _) )
    ->  true
    ;   report(Formal, Id, Sent),
        tell_origins(Formal, Id, Sent)
    ).

is_brought(mail(_, From, _)) :-
    compound(From).

was_sent_here(mail(Origin, _, _)) :-
    endpoint_address(Origin).

%   In a worker, because the bridge may have to wait.

give_back(Formal, Id, Mail) :-
    forall(member(One, Mail),
           scheduler_call(typhon_dead_letters:given_back(Formal, Id, One))).

given_back(Formal, Id, Mail) :-
    Mail = mail(_, From, Message),
    (   returned(From, Id, Message)
    ->  true
    ;   report(Formal, Id, [Mail])
    ).

tell_origins(Formal, Id, Mail) :-
    findall(Origin, member(mail(Origin, _, _), Mail), Origins0),
    sort(Origins0, Origins),
    forall(( member(Origin, Origins), \+ endpoint_address(Origin) ),
           scheduler_call(tell_origin(Origin, Formal, Id, Mail))).

tell_origin(Origin, Formal, Id, Mail) :-
    findall(mail(Origin, From, Message),
            member(mail(Origin, From, Message), Mail), Lost),
    catch(endpoint_post(Origin, message, lost(Formal, Id, Lost)),
          error(unreachable(_), _),
          true).                        % it was reported here

report(Formal, Id, [mail(_, From, Message)|More]) :-
    (   More == []
    ->  Told = undeliverable(Formal, Id, From, Message)
    ;   length(More, Others),
        Told = undeliverable(Formal, Id, From, Message, Others)
    ),
    print_message(warning, typhon(Told)).

typhon_endpoint:received(message, lost(Formal, Id, Mail), _) :-
    must_be(list(typhon_mail), Mail),
    partition(is_brought, Mail, Brought, Sent),
    give_back(Formal, Id, Brought),
    (   Sent == []
    ->  true
    ;   report(Formal, Id, Sent)
    ).

typhon_durable_posts:undelivered(message, shown(_, Message), Endpoint, Formal) :-
    typhon_durable_posts:undelivered(message, Message, Endpoint, Formal).
typhon_durable_posts:undelivered(message, message(Id, Mail, _), _, Formal) :-
    mail_lost(Formal, Id, Mail).

error:has_type(typhon_mail, Mail) :-
    subsumes_term(mail(_, _, _), Mail),
    arg(1, Mail, Origin),
    atom(Origin).
