:- module(sieve_operator,
          [ sieve_start/3,              % +Hosts, +Application, +Options
            antigen_attack/2,           % +Hosts, +Antigen
            antibody_release/5          % +Host, +Application, +Antibody,
                                        % +Options, -Agent
          ]).
:- use_module('../../prolog/typhon',
              [agent_create/3, agent_send/2, remote/2]).
:- use_module('../../prolog/typhon/kernel/base/options', [check_options/2]).
:- use_module('../../prolog/typhon/kernel/program/paths', []).
:- use_module('../lib/settings', [setting_facts/3]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(lists), [memberchk/2]).

/** <module> The idiotypic sieve, for users and programs

Creates guards on hosts, and attacks hosts with antigens (thesis chapter 3).
The hosts generate antibodies themselves.  Hosts are addresses, so these
predicates work from any process with the cookie, also if another process
started the hosts.

An application is a payload file, such as payloads(sieve/bits), that provides

  - affinity(+Antigen, +Antibody, -Psi), affinity_threshold(-Gamma)
    An antibody can neutralize the antigen if Psi >= Gamma, both numbers.
  - feedback(+Antigen, +Antibody, -Xi)
    The quality of the service: the argument of equation 3.2.
  - random_antibody(+Chance0, -Antibody, -Chance)
    Drawn by typhon_prng.
  - similar(+Antigen, +Other)
    Optional; without it different antigens are not similar.

*Threading*: any thread; no state.
*/

:- multifile
    agent_settings:takes/4,
    typhon_options:declared/4.

%!  sieve_start(+Hosts, +Application, +Options) is det.
%
%   Each of Hosts gets a guard with the payload Application, if it has none.
%   Options: settings(Pairs), Name-Value, to replace the defaults in
%   parameters.pl, for the guards and all antibodies they release.
%
%   @error domain_error(sieve_option, Option), domain_error(setting, X)
%   @error type_error(list, X), existence_error(host, Host),
%   host_unreachable(Host)

sieve_start(Hosts, Application, Options) :-
    must_be(list(atom), Hosts),
    check_options(sieve_option, Options),
    setting_facts(sieve_start, Options, Settings),
    maplist(guarded(Application, Settings), Hosts).

typhon_options:declared(sieve_option, settings(X), list, X).

agent_settings:takes(sieve_start,
                     [agents(sieve/guard), agents(sieve/antibody)], [], taken).
agent_settings:takes(antibody_release, [agents(sieve/antibody)], [], taken).

guarded(_, _, Host) :-
    remote(Host, sense(guard(_))),
    !.
guarded(Application, Settings, Host) :-
    agent_create(agents(sieve/guard), Guard,
                 [ host(Host), static(true), payloads([Application]),
                   facts([application(Application)|Settings])
                 ]),
    remote(Host, leave(guard(Guard))).

%!  antigen_attack(+Hosts, +Antigen) is det.
%
%   Antigen, a ground term, attacks each of Hosts.  A host handles attacks one
%   after the other.
%
%   @error existence_error(guard, Host), host_unreachable(Host)

antigen_attack(Hosts, Antigen) :-
    must_be(list(atom), Hosts),
    must_be(ground, Antigen),
    maplist(attack(Antigen), Hosts).

attack(Antigen, Host) :-
    (   remote(Host, sense(guard(Guard)))
    ->  agent_send(Guard, attack(Antigen))
    ;   existence_error(guard, Host)
    ).

%!  antibody_release(+Host, +Application, +Antibody, +Options, -Agent)
%!      is det.
%
%   Creates Agent at Host.  It carries Antibody and has met no antigen yet.
%   Options are those of sieve_start/3.

antibody_release(Host, Application, Antibody, Options, Agent) :-
    check_options(sieve_option, Options),
    setting_facts(antibody_release, Options, Settings),
    (   memberchk(setting(gamma, Gamma), Settings)
    ->  true
    ;   Gamma = 1.0
    ),
    agent_create(agents(sieve/antibody), Agent,
                 [ host(Host), payloads([Application]),
                   facts([ antibody(Antibody), gamma(Gamma), memory([]),
                           wins(0), expiry(inf), shunned([])
                         | Settings
                         ])
                 ]).
