:- module(typhon_parking,
          [ parked_in_fleet/2,          % +Fleet, -Parked
            parked_drop/2,              % +Fleet, +Agent
            parked_send/2               % +Fleet, +Agent
          ]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(lists), [append/2, append/3, member/2]).
:- use_module(library(option), [option/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/agent', [agent_home/2, agent_home_endpoint/2, agent_on/2]).
:- use_module('../../kernel/base/durable',
              [ after_unit/1, durable/5, durable_assertz/1, durable_drop/3,
                durable_on/0, durable_restores/0, sync_changes/0,
                unit_of_work/1 ]).
:- use_module('../../kernel/base/reports', [report/4]).
:- use_module('../../kernel/base/text', [term_text/2, text_term/2]).
:- use_module('../../kernel/host',
              [ address_parts/3, alarm_in/3, host/3, hosts_apart/2,
                scheduler_call/1, time_now/1 ]).
:- use_module('../../kernel/travel',
              [ mail_admit/3, mail_again/2, mail_lost/3, news_send/3, parcel_admit/3,
                parcel_returned/3, senders_checked/0, transfer_arrived/1,
                transfer_parcel/2, transfer_stays/2 ]).
:- use_module('../../kernel/wire',
              [endpoint_address/1, endpoint_call/5, mobile_term/1]).
:- use_module(engine, [engine_run_id/2, engine_script/4]).
:- use_module(members,
              [ fleet_host/3, fleet_joined/2, fleet_member/3,
                must_be_fleet/1 ]).

/** <module> Agents and messages that wait in the engine for a host

Parking is a hop that the engine accepts in the name of a host: the process that
the agent leaves keeps it, in transit, until the engine has it for certain, and
the process of the host recognises it by the number of the hop if it comes
twice.  Where the engine may lose its last second, that is certain after two
seconds in which it was not started again.  While it does not answer, the agent
stays in transit: it may be parked.

A process that takes an agent claims it first.  From then on the agent cannot
return to its sender, since it may be on its host.  The entry is deleted after
the commit.  A process without a journal that is killed between these two steps
gets the agent again when it is back.

*Threading*: workers, which may wait; the hooks in any thread.  One thread at a
time takes what is parked, and one sends the letters for an agent.
*/

:- multifile
    prolog:error_message//1,
    typhon_durable:go_on/0,
    typhon_mail:mail_kept/3,
    typhon_members:beaten/4,
    typhon_on_demand:joins/2,
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2,
    typhon_transfer:parks/2.

:- setting(typhon_fleet:parcel_bytes, positive_integer, 16777216,
           "The longest agent or letter that is parked, as text").
:- setting(typhon_fleet:parked_items, positive_integer, 10000,
           "Agents and letters that are parked for a process").
:- setting(typhon_fleet:parked_bytes, positive_integer, 268435456,
           "Bytes that are parked for a process").
:- setting(typhon_fleet:letters, positive_integer, 10000,
           "Letters that wait here until the engine answers").
:- setting(typhon_fleet:sure_seconds, number, 2,
           "Seconds until what an engine with fsync(everysec) has accepted \c
            counts as kept").

:- dynamic
    busy/1,                     % taking(Fleet) or letters(Id): a thread is
    letter/3,                   % Id, N, letter(Name, Formal, Mail): to park
    sent/3.                     % Name, Fleet-Run, Until: parked in an engine
                                % that may lose it until then

typhon_on_demand:joins(fleet, joined).

                /*******************************
                *            AGENTS            *
                *******************************/

typhon_transfer:parks(Transfer, Seconds) :-
    fleet_host(_, _, _),                % else it could not return
    !,
    until(Seconds, Until),
    Ticket is random(1<<62),
    scheduler_call(typhon_parking:park(Transfer, Until, Ticket-0)).

until(inf, inf) :-
    !.
until(Seconds, Until) :-
    time_now(Now),
    Until is Now+Seconds.

park(Transfer, Until, Ticket) :-
    catch(asked(Transfer, Until, Ticket, Answer), error(Formal, _),
          ( is_outage(Formal) -> Answer = unknown ; Answer = late )),
    parked(Answer, Transfer, Until, Ticket).

is_outage(resource_error(What)) :-
    What \== c_stack.                   % of term_text/2
is_outage(journal_unreachable(_, _)).
is_outage(existence_error(_, _)).       % the journal or fleet ends

%   asked(+Transfer, +Until, +Ticket, -Answer): Answer is kept(Fleet, Run), or
%   why not.  What the agent has done before must be committed before.  Ticket
%   is N-1 if an engine has accepted it, and may have lost all since.

asked(Transfer, Until, Ticket-Known, Answer) :-
    Transfer = transfer(Id, dest(Address, _, Endpoint), Hops),
    transfer_parcel(Transfer, Parcel),
    !,
    arg(1, Parcel, From),
    mobile_term(Parcel),
    term_text(Parcel, Text),
    sync_changes,
    (   fits(Text)
    ->  milliseconds(Until, Ttl),
        bounds(Most, Bytes),
        in_fleets(park,
                  [ Endpoint, Address, Id, Hops, Ttl, From, Ticket, Known, Most,
                    Bytes, Text ],
                  stranger, Answer)
    ;   Answer = full
    ).
asked(_, _, _, given_up).

fits(Text) :-
    setting(typhon_fleet:parcel_bytes, Most),
    string_length(Text, Length),
    Length =< Most.

bounds(Most, Bytes) :-
    setting(typhon_fleet:parked_items, Most),
    setting(typhon_fleet:parked_bytes, Bytes).

milliseconds(inf, inf) :-
    !.
milliseconds(Until, Ttl) :-
    time_now(Now),
    Ttl is max(0, ceiling(1000*(Until-Now))).

%   in_fleets(+Script, +Args, +No, -Answer): of the first fleet whose engine
%   does not answer No.

in_fleets(Script, Args, No, Answer) :-
    findall(Fleet, fleet_joined(Fleet, _), Fleets),
    ( Fleets == [] -> existence_error(fleet, any) ; true ),
    in_fleets(Fleets, Script, Args, No, Answer).

in_fleets([], _, _, No, No).
in_fleets([Fleet|Fleets], Script, Args, No, Answer) :-
    engine_run_id(Fleet, Run),
    engine_script(Fleet, Script, Args, Answer0),
    atom_string(Answer1, Answer0),
    (   Answer1 == No
    ->  in_fleets(Fleets, Script, Args, No, Answer)
    ;   Answer1 == ok
    ->  Answer = kept(Fleet, Run)
    ;   Answer = Answer1
    ).

parked(kept(Fleet, Run), Transfer, Until, Ticket-_) :-
    !,
    (   confirms_all(Fleet)
    ->  is_parked(Transfer)
    ;   setting(typhon_fleet:sure_seconds, Seconds),
        arg(1, Transfer, Id),
        alarm_in(Seconds, Id, parked(Fleet-Run, Transfer, Until, Ticket-1))
    ).
parked(unknown, Transfer, Until, Ticket) :-
    !,
    arg(1, Transfer, Id),
    alarm_in(1, Id, parked(none, Transfer, Until, Ticket)).
parked(given_up, Transfer, _, _) :-
    !,
    transfer_stays(Transfer, given_up).
parked(_, Transfer, _, _) :-
    arg(2, Transfer, dest(Address, _, _)),
    transfer_stays(Transfer, host_unreachable(Address)).

confirms_all(Fleet) :-
    fleet_joined(Fleet, Options),
    option(fsync(always), Options, fsync(everysec)).

typhon_scheduler:fire(_, parked(Kept, Transfer, Until, Ticket)) :-
    !,
    scheduler_call(typhon_parking:sure(Kept, Transfer, Until, Ticket)).

sure(Kept, Transfer, Until, Ticket) :-
    (   Kept = Fleet-Run,
        catch(engine_run_id(Fleet, Run), error(_, _), fail)
    ->  is_parked(Transfer)
    ;   park(Transfer, Until, Ticket)
    ).

%   No process that has the agent informs its home.  In virtual time the process
%   that takes it is this one, where the frozen agent waits for its hop.

is_parked(transfer(_, dest(_, _, Endpoint), _)) :-
    endpoint_address(Endpoint),
    !.
is_parked(Transfer) :-
    Transfer = transfer(Id, dest(Address, _, Endpoint), Hops),
    transfer_arrived(Transfer),
    agent_home_endpoint(Id, Home),
    (   ( endpoint_address(Home) ; Home == Endpoint )
    ->  true
    ;   news_send(Home, Id, located(Id, Address, Hops))
    ).

                /*******************************
                *            LETTERS           *
                *******************************/

%   The letter is noted in the unit of work in which it leaves, and parked after
%   the commit.  Where senders are checked, mail_admit/3 would refuse messages
%   of agents, whose proofs are not kept.

typhon_mail:mail_kept(Formal, Id, Mail) :-
    fleet_joined(_, _),
    atom(Id),
    \+ ( senders_checked, is_from_agent(Mail) ),
    catch(term_text(Mail, Text), error(_, _), fail),
    fits(Text),
    letter_asked(Id, '', "", Mail, Answer),
    may_wait(Answer, Id),
    format(atom(Name), 'letter~36r', [random(1<<90)]),
    durable_assertz(letter(Id, _, letter(Name, Formal, Mail))),
    (   durable_on
    ->  after_unit(typhon_parking:letters_soon(Id))
    ;   letters_sent(Id)
    ).

%   An agent that has returned to this process meanwhile gets its letter here.

may_wait(kept(_, _), _).
may_wait(none, Id) :-
    agent_on(Id, _).
may_wait(unknown, _) :-
    predicate_property(letter(_, _, _), number_of_clauses(Count)),
    setting(typhon_fleet:letters, Most),
    Count < Most.

%   In virtual time the sender knows where the letter is.

own_process([mail(_, From, _)|_], Host) :-
    fleet_member(_, Host, _),
    agent_on(From, Name),
    host(Name, Host, _),
    !.
own_process(_, Own) :-
    endpoint_address(Own),
    !.
own_process(_, '').

is_from_agent(Mail) :-
    member(mail(_, From, _), Mail),
    atom(From),
    agent_home(From, _),
    !.

:- durable(fleet_letter, Id, N, Letter, letter(Id, N, Letter)).

typhon_durable:go_on :-
    forall(letter(Id, _, _), send_later(Id)).

letters_soon(Id) :-
    scheduler_call(typhon_parking:letters_sent(Id)).

send_later(Id) :-
    alarm_in(1, Id, parked_letters).

typhon_scheduler:fire(Id, parked_letters) :-
    !,
    letters_soon(Id).

typhon_scheduler:over(Id, parked_letters) :-
    \+ letter(Id, _, _).

%   A thread that finds another one sending leaves its letter to that.

letters_sent(Id) :-
    (   letter(Id, _, _),
        alone(letters(Id), typhon_parking:letters_sent(Id, Answer))
    ->  (   Answer == unknown
        ->  send_later(Id)
        ;   letter(Id, _, letter(Name, _, _)),
            \+ sent(Name, _, _)
        ->  letters_sent(Id)
        ;   true
        )
    ;   true
    ).

letters_sent(Id, Answer) :-
    (   catch(findall(Fleet-Run, ( fleet_joined(Fleet, _),
                                   engine_run_id(Fleet, Run) ),
                      Runs),
              error(_, _), fail)
    ->  forget_sure(Id, Runs),
        send_letters(Id, Runs, Answer)
    ;   Answer = unknown
    ).

forget_sure(Id, Runs) :-
    time_now(Now),
    forall(( letter(Id, N, letter(Name, Formal, Mail)),
             sent(Name, Run, Until),
             Until =< Now,
             memberchk(Run, Runs) ),
           letter_over(Id, N, letter(Name, Formal, Mail))).

%   All that an engine may have lost since it was started again is sent again,
%   in order.

send_letters(Id, Runs, Answer) :-
    (   letter(Id, N, Letter),
        Letter = letter(Name, Formal, Mail),
        \+ ( sent(Name, Run, _), memberchk(Run, Runs) )
    ->  term_text(Mail, Text),
        letter_asked(Id, Name, Text, Mail, Answer0),
        (   Answer0 == unknown
        ->  Answer = unknown
        ;   letter_sent(Answer0, Id, N, Letter, Gone),
            ( Gone == lost -> mail_lost(Formal, Id, Mail) ; true ),
            send_letters(Id, Runs, Answer)
        )
    ;   Answer = none
    ).

letter_sent(kept(Fleet, Run), Id, _, letter(Name, _, _), kept) :-
    \+ confirms_all(Fleet),
    !,
    setting(typhon_fleet:sure_seconds, Seconds),
    until(Seconds, Until),
    retractall(sent(Name, _, _)),
    assertz(sent(Name, Fleet-Run, Until)),
    alarm_in(Seconds, Id, parked_letters).
letter_sent(none, Id, N, Letter, gone) :-       % it was taken meanwhile
    !,
    Letter = letter(_, _, Mail),
    unit_of_work(( letter_over(Id, N, Letter), mail_again(Id, Mail) )).
letter_sent(Answer, Id, N, Letter, Gone) :-
    letter_over(Id, N, Letter),
    ( Answer = kept(_, _) -> Gone = kept ; Gone = lost ).

letter_over(Id, N, letter(Name, _, _)) :-
    durable_drop(fleet_letter, Id, N),
    retractall(sent(Name, _, _)),
    retractall(letter(Id, _, letter(Name, _, _))).

letter_asked(Id, Name, Text, Mail, Answer) :-
    bounds(Most, Bytes),
    own_process(Mail, Own),
    catch(( ( Name == '' -> true ; sync_changes ),
            in_fleets(mail, [Own,Id,Name,Most,Bytes,Text], none, Answer) ),
          error(Formal, _),
          ( is_outage(Formal) -> Answer = unknown ; Answer = none )).

:- meta_predicate alone(+, 0).

alone(What, Goal) :-
    setup_call_cleanup(
        with_mutex(typhon_parking,
                   ( \+ busy(What), assertz(busy(What)) )),
        once(Goal),
        retractall(busy(What))).

                /*******************************
                *            TAKING            *
                *******************************/

typhon_members:beaten(Fleet, Endpoint, Parked, _) :-
    Parked > 0,
    scheduler_call(typhon_parking:take(Fleet, Endpoint)).

%   Agents that a journal restores come first.

take(Fleet, Endpoint) :-
    (   durable_restores
    ->  true
    ;   ignore(reporting(Fleet, alone(taking(Fleet),
                                      typhon_parking:take(Fleet, Endpoint,
                                                          '0-0', []))))
    ).

:- meta_predicate reporting(+, 0).

reporting(What, Goal) :-
    catch(Goal, error(Formal, Context),
          ( report(warning, parked, What,
                   typhon(raised(error(Formal, Context)))),
            fail )).

take(Fleet, Endpoint, After, Done) :-
    fleet_member(Fleet, Endpoint, Token),
    hosts_of(Endpoint, Hosts),
    length(Hosts, Count),
    append([[Endpoint,Token,After,Count], Hosts, Done], Args),
    engine_script(Fleet, take, Args, [Last,Rows]),
    (   Last == ""
    ->  true
    ;   findall(Entry,
                ( member([Entry|Row], Rows),
                  reporting(Fleet, typhon_parking:taken(Row, Fleet, Token)) ),
                Entries),
        sync_changes,
        take(Fleet, Endpoint, Last, Entries)
    ).

%   In virtual time each host stands for a process.

hosts_of(Host, [Host]) :-
    host(_, Host, _),
    !.
hosts_of(_, Hosts) :-
    findall(Address, host(_, Address, _), Hosts).

%   taken(+Row, +Fleet, +Token) is semidet: it is in this process, or has been;
%   its entry can be deleted.

taken(["mail",Id0,Name0,Text], _, _) :-
    atom_string(Id, Id0),
    atom_string(Name, Name0),
    (   readable(Text, Mail),
        is_list(Mail),
        forall(member(One, Mail), is_mail(One))
    ->  \+ is_cut_off(Mail, Id),
        mail_admit(Name, Id, Mail)
    ;   unreadable(Id)
    ).
taken(["agent",Id0,To0,Why,Text], Fleet, Token) :-
    atom_string(Id, Id0),
    atom_string(To, To0),
    (   readable(Text, Parcel0),
        parcel_of(Parcel0, Id)
    ->  let_in(Why, Parcel0, Peer, Parcel),
        arg(2, Parcel, To),
        parcel_admit(Parcel, Peer, Answer)
    ->  true
    ;   unreadable(Id),
        Answer = refused(error(syntax_error(parcel)))
    ),
    admitted(Answer, To, Fleet, Id, Token).

%   In virtual time a letter also waits until its sender is not away.

is_cut_off(Mail, Id) :-
    agent_on(Id, Here),
    member(mail(_, From, _), Mail),
    agent_on(From, There),
    hosts_apart(Here, There).

is_mail(Mail) :-
    subsumes_term(mail(_, _, _), Mail),
    arg(1, Mail, Origin),
    atom(Origin).

readable(Text, Term) :-
    fits(Text),
    catch(text_term(Text, Term), error(_, _), fail).

parcel_of(parcel(From, To, Image, Held, _), Id) :-
    ground(From-To),
    subsumes_term(image(_, _, _, _, _, _, _), Image),
    arg(1, Image, Id0),
    Id0 == Id,
    subsumes_term(_-_, Held).

unreadable(Id) :-
    report(error, parked, Id,
           typhon(raised(error(syntax_error(parcel), _)))).

%   let_in(+Why, +Parcel0, -Peer, -Parcel): Why is "" of an agent that comes;
%   others return.

let_in("", Parcel, Peer, Parcel) :-
    !,
    arg(1, Parcel, From),
    address_parts(From, _, Peer).
let_in(Why, Parcel0, Peer, Parcel) :-
    arg(2, Parcel0, To),
    address_parts(To, _, Peer),
    (   Why \== "expired",
        readable(Why, Formal),
        subsumes_term(move_refused(_, _), Formal)
    ->  true
    ;   Formal = host_unreachable(To)
    ),
    parcel_returned(Parcel0, Formal, Parcel).

admitted(accepted, _, _, _, _) :-
    !.
admitted(Answer, To, Fleet, Id, Token) :-
    ( Answer = refused(Reason) -> true ; Reason = Answer ),
    copy_term(move_refused(To, Reason), Formal, _),
    term_text(Formal, Why),
    engine_script(Fleet, unpark, [back,Id,Token,Why], _),
    fail.

                /*******************************
                *         FOR OPERATORS        *
                *******************************/

%!  parked_in_fleet(+Fleet, -Parked:list) is det.
%!  parked_drop(+Fleet, +Agent) is det.
%!  parked_send(+Fleet, +Agent) is det.
%
%   See fleet_parked/2, fleet_park_drop/2 and fleet_park_send/2.

parked_in_fleet(Fleet, Parked) :-
    must_be_fleet(Fleet),
    engine_script(Fleet, parked, [], Rows),
    findall(parked(Id, Host, Since, Until),
            ( member([Id0,Host0,Since0,Until0], Rows),
              atom_string(Id, Id0),
              atom_string(Host, Host0),
              seconds(Since0, Since),
              seconds(Until0, Until) ),
            Parked0),
    sort(3, @=<, Parked0, Parked).

seconds("inf", inf) :-
    !.
seconds(Text, Seconds) :-
    number_string(Milliseconds, Text),
    Seconds is Milliseconds/1000.0.

parked_drop(Fleet, Id) :-
    unparked(Fleet, [back,Id,none,expired], _, _).

unparked(Fleet, Args, To, Text) :-
    must_be_fleet(Fleet),
    Args = [_,Id|_],
    must_be(atom, Id),
    (   engine_script(Fleet, unpark, Args, [To0,Text])
    ->  atom_string(To, To0)
    ;   existence_error(parked_agent, Id)
    ).

%   Only if the process of the host answers; then what becomes of the agent is
%   known, or that process takes it.

parked_send(Fleet, Id) :-
    Token is random(1<<62),
    unparked(Fleet, [claim,Id,Token], To, Text),
    address_parts(To, Name, Endpoint),
    (   readable(Text, parcel(_, _, Image, _, Program))
    ->  true
    ;   existence_error(parked_agent, Id)
    ),
    catch(endpoint_call(Endpoint, hop, hop(Name, Image, Program),
                        answer(Answer), 10),
          error(unreachable(_), _), Answer = unreachable),
    sent(Answer, Fleet, Id, Token, To).

sent(accepted, Fleet, Id, Token, _) :-
    !,
    unparked(Fleet, [done,Id,Token], _, _).
sent(unreachable, Fleet, Id, Token, To) :-
    !,
    unparked(Fleet, [release,Id,Token], _, _),
    throw(error(host_unreachable(To), _)).
sent(Answer, Fleet, Id, Token, To) :-
    ignore(admitted(Answer, To, Fleet, Id, Token)).

                /*******************************
                *            MESSAGES          *
                *******************************/

prolog:error_message(existence_error(parked_agent, Id)) -->
    [ 'The agent ~w is not parked, or is being taken by its host'-[Id] ].
