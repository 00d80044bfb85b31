:- module(typhon_logged,
          [ agent_logs/3                % +Host, +Agent, +What
          ]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/durable', [durable/5]).
:- use_module('../base/durable_changes',
              [durable_drop/3, durable_number/1, unit_of_work/1]).
:- use_module('../base/deferred',
              [deferred_call/1, effects_deferred/0, deferred_put/4]).
:- use_module('../host', [host_log/3, host_log_event/4]).
:- use_module(durable_posts, [durable_post/3]).

/** <module> What agents log

With a journal that is part of what an agent does in a turn: it is noted with
the turn, and goes to the log server once, whoever dies.  What else a host
tells its log server it tells at once, see typhon_host_log.

*Threading*: the worker that runs the agent.
*/

:- multifile
    typhon_durable_posts:undelivered/4,
    typhon_durable:go_on/0.

:- dynamic said/4.                      % Host, N, Agent, What: before a restart

%!  agent_logs(+Host, +Agent, +What) is det.
%
%   Agent, which stands on Host, has said What, which can travel, to the log
%   server of Host, which it has.

agent_logs(Host, Agent, What) :-
    (   effects_deferred
    ->  durable_number(N),
        deferred_put(logged, Host, N, Agent-What),
        deferred_call(typhon_logged:go(Host, N, Agent, What))
    ;   host_log(Host, Agent, What)
    ).

:- public go/4.

go(Host, N, Agent, What) :-
    unit_of_work(( durable_drop(logged, Host, N),
                   post(Host, Agent, What) )).

post(Host, Agent, What) :-
    (   host_log_event(Host, Agent, What, Endpoint-Event)
    ->  catch(durable_post(Endpoint, log, Event),
              error(resource_error(frame_bytes), Context),
              print_message(warning,
                            error(resource_error(frame_bytes), Context)))
    ;   true                            % it has none any more
    ).

:- durable(logged, Host, N, Agent-What, said(Host, N, Agent, What)).

typhon_durable:go_on :-
    findall(said(Host, N, Agent, What),
            retract(said(Host, N, Agent, What)), All),
    forall(member(said(Host, N, Agent, What), All),
           go(Host, N, Agent, What)).

%   There is no log server there any more, or it cannot take this.

typhon_durable_posts:undelivered(log, event(_, Host, Agent, What), _, _) :-
    print_message(informational, typhon(log(Host, Agent, What))).
